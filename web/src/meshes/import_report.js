// import_report.js - a dialog with what the server repaired in a file and what it warns of. The
// reports are kept while the page is open, because the server sends each only once.

import { formatCount, make } from '../kit/dom.js';
import { linkTo, shortened } from '../kit/element_links.js';
import { sentencesOf, tallyOf } from './imported.js';

const NAMES = { vertex: ['Vertex', 'Vertices'], face: ['Face', 'Faces'] };

export class ImportReport {
    #elements;
    #onFollow;
    #reports = new Map(); // id of the mesh -> {file, report}
    #mesh = null;

    // `dialog` contains the other elements but `opener`, the button that shows the report of the
    // open mesh. The dialog does not cover the page, so that the user can look at one element after
    // another: `onFollow(kind, id)` is called when the link to an element is clicked.
    constructor({ dialog, file, close, repairs, warnings, opener }, { onFollow }) {
        this.#elements = { dialog, file, repairs, warnings, opener };
        this.#onFollow = onFollow;
        opener.addEventListener('click', () => this.open());
        close.addEventListener('click', () => dialog.close());
        dialog.addEventListener('keydown', (event) => {
            if (event.key === 'Escape') {
                dialog.close();
            }
        });
    }

    // Keeps the report of the import that made a mesh. Returns whether it tells of anything.
    keep(mesh, file, report) {
        const isTelling = report !== undefined && tallyOf(report) !== '';
        if (isTelling) {
            this.#reports.set(mesh, { file, report });
        }
        return isTelling;
    }

    // Called when another mesh is open.
    follow(mesh) {
        const { dialog, opener } = this.#elements;
        const kept = this.#reports.get(mesh);
        if (mesh !== this.#mesh) {
            dialog.close();
        }
        this.#mesh = mesh;
        opener.hidden = kept === undefined;
        opener.textContent = kept === undefined ? '' : `Import: ${tallyOf(kept.report)}`;
    }

    // Shows the report of the open mesh.
    open() {
        const { dialog, file, repairs, warnings } = this.#elements;
        const kept = this.#reports.get(this.#mesh);
        if (kept === undefined) {
            return;
        }
        const sentences = sentencesOf(kept.report);
        file.textContent = kept.file;
        this.#fill(repairs, sentences.repairs);
        this.#fill(warnings, sentences.warnings);
        dialog.close();
        dialog.show();
    }

    #fill(list, sentences) {
        list.parentElement.hidden = sentences.length === 0;
        list.replaceChildren(...sentences.map((sentence) => this.#row(sentence)));
    }

    #row({ text, elements }) {
        const groups = elements.filter(({ ids }) => ids.length > 0);
        return make('li', {}, text, ...groups.map((group) => this.#links(group)));
    }

    #links({ kind, ids, more }) {
        const [one, many] = NAMES[kind];
        const links = shortened(ids, (id) => linkTo(kind, id, this.#onFollow));
        const rest = more > 0 ? [`and ${formatCount(more)} more`] : [];
        const name = ids.length === 1 ? one : many;
        return make('p', { className: 'many' }, `${name} `, ...links, ...rest);
    }
}
