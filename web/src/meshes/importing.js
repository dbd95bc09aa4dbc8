// importing.js - what the page does when a file was imported or refused: it says what was found, and
// offers repairs.

import * as api from '../wire/api.js';
import { DEFECTS, defectsIn, defectsOf, sizesOf } from './defects.js';
import { exportNow, formatOf, labelOf, preferFormat } from './exporting.js';
import { formatCount } from '../kit/dom.js';
import { nameInText } from '../wire/names.js';
import { offerRepairs } from './offer.js';

// The largest number of findings that a message lists.
const MOST = 4;

export class Importing {
    #toasts;
    #report;
    #onOpen;

    // `report` keeps what each import has repaired and warned of. `onOpen(summary)` opens a new mesh
    // and returns a promise.
    constructor({ toasts, report }, onOpen) {
        [this.#toasts, this.#report, this.#onOpen] = [toasts, report, onOpen];
    }

    // Opens the mesh that was made from a file. Returns the button for its report, null if that is
    // empty.
    async #open(summary, file) {
        const isTelling = this.#report.keep(summary.id, file.name, summary.import);
        const format = formatOf(file.name);
        if (format !== null) {
            preferFormat(format);
        }
        await this.#onOpen(summary);
        return isTelling ? { label: 'Show report', run: () => this.#report.open() } : null;
    }

    // Opens the mesh that was made from a file, and says what is wrong with it.
    async done(summary, batch) {
        const name = nameInText(batch.file.name);
        const more = await this.#open(summary, batch.file);
        const [check, tag] = await Promise.all([api.check(summary.id), api.getTag(summary.id)]).catch(
            () => [null, null],
        );
        const found = defectsIn(summary, check);
        const words = [
            ...found.filter(({ code }) => code !== 'open_border').map(({ text }) => text),
            ...remarksOf(summary),
        ];
        const rest = words.length > MOST ? [`${formatCount(words.length - MOST)} more notes`] : [];
        const lines = [sizesOf(summary), ...words.slice(0, MOST), ...rest];
        const text = lines.map((line) => `${line}.`).join(' ');
        const offer = () => this.#offerFor(summary, batch, found, tag);
        const isMendable = found.length > 0 && tag !== null;
        this.#toasts.tell(
            `Read ${name}`,
            text,
            isMendable ? { label: 'Repair\u2026', run: () => offer().catch((e) => this.#toasts.show(e)) } : more,
        );
    }

    // Offers to use a repaired mesh in place of the one that was made from the file.
    #offerFor(summary, batch, found, tag) {
        const hasHoles = found.some(({ code }) => code === 'open_border');
        const menders = found.flatMap(({ mender }) => mender ?? []);
        const chosen = [...new Set([...menders, ...(hasHoles ? fillsOf(batch.file) : [])])];
        const words = {
            title: `Repair ${nameInText(batch.file.name)}`,
            lead: 'The file was imported. A check of the mesh has found:',
            go: 'Use repaired mesh',
        };
        return offerRepairs(batch, words, { found, chosen }, async (repaired) => {
            const more = await this.#open(repaired, batch.file);
            // The unrepaired mesh stays if it was changed since.
            const isGone = await api.remove(summary.id, tag).then(
                () => true,
                () => false,
            );
            const end = isGone ? '' : ' The mesh without repairs was changed meanwhile and stays, too.';
            await this.#onOpen(repaired);
            this.#tellRepaired(`Repaired ${nameInText(batch.file.name)}`, `${sizesOf(repaired)}.${end}`, {
                repaired,
                file: batch.file,
                more,
            });
        });
    }

    // Says why a file was refused. If repairs would make it acceptable, offers them, and returns
    // when the user has decided.
    async refused(error, batch) {
        if (!(error.repair?.length > 0)) {
            this.#toasts.show(error);
            return;
        }
        const name = nameInText(batch.file.name);
        const words = {
            title: `Repair ${name}`,
            lead: 'The file was refused, because a half-edge mesh cannot hold this:',
            go: 'Import repaired mesh',
        };
        const chosen = [...new Set([...error.repair, ...fillsOf(batch.file)])];
        await offerRepairs(batch, words, { found: defectsOf(error), chosen }, async (repaired) => {
            const more = await this.#open(repaired, batch.file);
            this.#tellRepaired(`Read ${name} with repairs`, `${sizesOf(repaired)}.`, {
                repaired,
                file: batch.file,
                more,
            });
        });
    }

    // Says that a mesh was repaired, and offers the repaired file, in the format that it had. `more` is
    // the button for the report of the import, or null.
    #tellRepaired(title, text, { repaired, file, more }) {
        const format = formatOf(file.name);
        const download = {
            label: format === null ? '' : `Download ${labelOf(format)}`,
            run: () =>
                exportNow(repaired, format, this.#toasts).catch((error) => this.#toasts.show(error)),
        };
        this.#toasts.tell(title, text, [format === null ? null : download, more]);
    }
}

// Returns the repairs that fill holes, if every hole of such a file is a defect: STL is for solids,
// while other formats are also for surfaces with a border.
function fillsOf(file) {
    return formatOf(file.name) === 'stl' ? ['fill'] : [];
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
