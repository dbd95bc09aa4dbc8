// links_menu.js - on a telephone the bar has no room for the links at its end, so a menu offers them.

import { Menu } from '../kit/menu.js';

// `button` opens the menu. It offers the links and buttons beside it that have no room. Others are not
// seen because they are of no use, such as the name of the token if the server requires none, or the
// examples if the user may not make meshes; the menu does not offer these. If nothing lacks room, because
// the window has become wider since the button was pressed, no menu opens.
export function offerLinks(button) {
    const menu = new Menu();
    button.addEventListener('click', () => {
        const hidden = [...button.parentElement.children].filter(
            (one) =>
                one !== button &&
                !one.checkVisibility() &&
                !one.matches('[hidden], .looks-only .edits'),
        );
        const items = hidden.map((one) => ({
            label: one.ariaLabel ?? one.textContent,
            run: () => one.click(),
        }));
        if (items.length > 0) {
            menu.open(button, button.ariaLabel, items);
        }
    });
}
