// labels.js - texts at places of the mesh, over the view.

import { make } from '../kit/dom.js';

export class Labels {
    #box;
    #stage;
    #shown = []; // {node, point}

    // `box` covers the view.
    constructor(box, stage) {
        [this.#box, this.#stage] = [box, stage];
    }

    // Shows labels, {text, point} each; points are in view coordinates.
    show(labels) {
        this.#shown = labels.map(({ text, point }) => ({
            node: make('span', { className: 'ruler-label' }, text),
            point,
        }));
        this.#box.replaceChildren(...this.#shown.map(({ node }) => node));
        this.place();
    }

    // Called after each frame: moves the labels to where their places appear.
    place() {
        for (const { node, point } of this.#shown) {
            const place = this.#stage.placeOf(point);
            node.hidden = place === null;
            if (place !== null) {
                const [x, y] = place.map((value) => Math.round(value));
                node.style.transform = `translate(${x}px, ${y}px) translate(-50%, -140%)`;
            }
        }
    }
}
