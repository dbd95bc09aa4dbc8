// selections.js - draws what other clients have selected, in their colours and with their names
// beside it.

import { meanOf, shapeOfMarks } from '../geometry/changed.js';
import { placeOnScreen } from '../geometry/view.js';
import { make } from '../kit/dom.js';
import { isIn, markOf, readAll } from '../open/selection.js';
import { nameOf } from './people.js';

export class Selections {
    #box;
    #stage;
    #onError;
    #turn = 0; // counts calls of show(); only the last one counts
    #labels = []; // {node, point}

    // `box` lies over the view and gets the names.
    constructor(box, stage, onError) {
        this.#box = box;
        this.#stage = stage;
        this.#onError = onError;
    }

    // Shows the selections of the clients of Others.besides() on the mesh of a Content; null shows
    // none.
    show(content, others) {
        const turn = ++this.#turn;
        this.#read(content, others)
            .then((marks) => turn === this.#turn && this.#draw(content, others, marks))
            .catch((error) => error.status !== 0 && this.#onError(error));
    }

    // Returns the marks of each client's selection, see markOf().
    async #read(content, others) {
        const elements = others.map(({ selection }) =>
            (selection?.ids ?? []).map((id) => ({ kind: selection.kind, id })),
        );
        return Promise.all(
            elements.map(async (chosen) => {
                // Faces and vertices are found in the arrays, the ends of edges are asked for.
                const isPlain = chosen.every(({ kind }) => kind === 'face' || kind === 'vertex');
                return isPlain ? chosen : (await readAll(content.mesh, chosen))[0].map(markOf);
            }),
        );
    }

    #draw(content, others, marks) {
        const geometry = content?.geometry;
        const shapes = others.map(({ color }, i) => ({
            color,
            ...shapeOfMarks(geometry, marks[i].filter((mark) => isIn(geometry, mark))),
        }));
        this.#stage.tint('others', shapes);
        this.#labels = shapes.flatMap(({ triangles, lines, dots }, i) => {
            const point = meanOf(triangles, triangles.length > 0 ? [] : lines, dots);
            const node = make('span', { className: 'who' }, make('bdi', {}, nameOf(others[i])));
            node.style.borderColor = others[i].color;
            return point === null ? [] : [{ node, point }];
        });
        this.#box.replaceChildren(...this.#labels.map(({ node }) => node));
        this.place();
    }

    // Puts the names beside the selections; called after each frame.
    place() {
        const { matrix } = this.#stage;
        if (this.#labels.length === 0 || matrix === undefined) {
            return;
        }
        const { clientWidth: width, clientHeight: height } = this.#box;
        for (const { node, point } of this.#labels) {
            const place = placeOnScreen({ matrix, width, height }, point);
            const isSeen =
                place !== null &&
                place.every((value, axis) => value >= 0 && value <= [width, height][axis]);
            node.hidden = !isSeen;
            if (isSeen) {
                node.style.transform = `translate(${place[0]}px, ${place[1]}px)`;
            }
        }
    }
}
