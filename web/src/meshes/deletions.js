// deletions.js - deletes meshes after ten seconds in which the user can think again. Only this page
// knows that a mesh is about to be deleted: if the page is left, the mesh stays.
//
// A deletion names the state of the mesh that the user saw. If another client changes the mesh
// during the ten seconds, the server refuses the deletion, and the mesh stays.

import * as api from '../wire/api.js';

// How many seconds the user has.
const SECONDS = 10;
const SECOND = 1000;

export class Deletions {
    #waiting = new Map(); // id of a mesh -> {toast, timer, tag}
    #toasts;
    #onMark;
    #onDeleted;

    // `onMark(id, isLeaving)` is called when a deletion begins to wait and when it ends;
    // `onDeleted(id)` when the server has deleted a mesh.
    constructor(toasts, { onMark, onDeleted }) {
        [this.#toasts, this.#onMark, this.#onDeleted] = [toasts, onMark, onDeleted];
        // A page that is left may be shown again later as it was; then nothing waits in it.
        window.addEventListener('pagehide', () => {
            [...this.#waiting.keys()].forEach((id) => this.undo(id));
        });
    }

    isWaiting(id) {
        return this.#waiting.has(id);
    }

    // Deletes a mesh in ten seconds; `title` are the words by which the user knows it.
    async begin(id, title) {
        if (this.isWaiting(id)) {
            return;
        }
        const entry = { tag: null, toast: null, timer: 0 };
        this.#waiting.set(id, entry);
        try {
            entry.tag = await api.getTag(id);
        } catch (error) {
            this.#waiting.delete(id);
            throw error;
        }
        if (!this.isWaiting(id)) {
            return; // the page was left
        }
        this.#onMark(id, true);
        entry.toast = this.#toasts.wait(`Deleting ${title}`, 'It is deleted in ten seconds.', {
            label: 'Undo',
            run: () => this.undo(id),
        });
        this.#count(id, title, SECONDS);
    }

    #count(id, title, left) {
        const entry = this.#waiting.get(id);
        entry.toast.show(`Deleted in ${left} s`);
        entry.timer = setTimeout(() => {
            if (left > 1) {
                this.#count(id, title, left - 1);
            } else {
                this.#delete(id, title, entry.tag).catch((error) => this.#toasts.show(error));
            }
        }, SECOND);
    }

    // Leaves the mesh as it is.
    undo(id) {
        const { toast, timer } = this.#waiting.get(id);
        clearTimeout(timer);
        this.#waiting.delete(id);
        this.#onMark(id, false);
        toast?.close();
    }

    async #delete(id, title, tag) {
        this.undo(id); // from here on it cannot be undone
        try {
            await api.remove(id, tag);
        } catch (error) {
            if (error.status === 412) {
                error.title = `${title} was not deleted`;
                error.detail = 'Another client changed it during the ten seconds.';
            }
            throw error;
        }
        await this.#onDeleted(id);
    }
}
