// importing.js - what the page does when a file was imported or refused: it says what was found, and
// offers repairs.

import * as api from './api.js';
import { DEFECTS, defectsIn, defectsOf, sizesOf } from './defects.js';
import { formatCount } from './dom.js';
import { offerRepairs } from './offer.js';

// The largest number of findings that a message lists.
const MOST = 4;

export class Importing {
    #toasts;
    #onOpen;

    // `onOpen(summary)` opens a new mesh and returns a promise.
    constructor(toasts, onOpen) {
        [this.#toasts, this.#onOpen] = [toasts, onOpen];
    }

    // Opens the mesh that was made from a file, and says what is wrong with it.
    async done(summary, batch) {
        const { name } = batch.file;
        await this.#onOpen(summary);
        const [check, tag] = await Promise.all([api.check(summary.id), api.getTag(summary.id)]).catch(
            () => [null, null],
        );
        const found = defectsIn(summary, check);
        const words = [
            ...found.filter(({ code }) => code !== 'open_border').map(({ text }) => text),
            ...remarksOf(summary),
        ];
        const more = words.length > MOST ? [`${formatCount(words.length - MOST)} more notes`] : [];
        const lines = [sizesOf(summary), ...words.slice(0, MOST), ...more];
        const text = lines.map((line) => `${line}.`).join(' ');
        const offer = () => this.#offerFor(summary, batch, found, tag);
        const isMendable = found.length > 0 && tag !== null;
        this.#toasts.tell(
            `Read ${name}`,
            text,
            isMendable ? { label: 'Repair\u2026', run: () => offer().catch((e) => this.#toasts.show(e)) } : null,
        );
    }

    // Offers to use a repaired mesh in place of the one that was made from the file.
    #offerFor(summary, batch, found, tag) {
        const chosen = [...new Set(found.flatMap(({ mender }) => mender ?? []))];
        const words = {
            title: `Repair ${batch.file.name}`,
            lead: 'The file was imported. A check of the mesh has found:',
            go: 'Use repaired mesh',
        };
        return offerRepairs(batch, words, { found, chosen }, async (repaired) => {
            await this.#onOpen(repaired);
            // The unrepaired mesh stays if it was changed since.
            const isGone = await api.remove(summary.id, tag).then(
                () => true,
                () => false,
            );
            const end = isGone ? '' : ' The mesh without repairs was changed meanwhile and stays, too.';
            this.#toasts.tell(`Repaired ${batch.file.name}`, `${sizesOf(repaired)}.${end}`);
            await this.#onOpen(repaired);
        });
    }

    // Says why a file was refused. If repairs would make it acceptable, offers them, and returns
    // when the user has decided.
    async refused(error, batch) {
        if (!(error.repair?.length > 0)) {
            this.#toasts.show(error);
            return;
        }
        const { name } = batch.file;
        const words = {
            title: `Repair ${name}`,
            lead: 'The file was refused, because a half-edge mesh cannot hold this:',
            go: 'Import repaired mesh',
        };
        const { repair: chosen } = error;
        await offerRepairs(batch, words, { found: defectsOf(error), chosen }, async (repaired) => {
            await this.#onOpen(repaired);
            this.#toasts.tell(`Read ${name} with repairs`, `${sizesOf(repaired)}.`);
        });
    }
}

// Returns the warnings of an import that are no defects, such as about images, which are not stored.
function remarksOf({ import: report }) {
    return (report?.warnings ?? [])
        .filter(({ code }) => !(code in DEFECTS))
        .map(({ detail, count }) => {
            const text = `${detail[0].toUpperCase()}${detail.slice(1)}`;
            return count > 1 ? `${text} (${formatCount(count)} times)` : text;
        });
}
