// dom.js - functions that build elements of the page. Text is always inserted as text, never parsed
// as HTML, so a mesh may have any name.

// Returns the page's element with an id.
export function byId(id) {
    return document.getElementById(id);
}

// Returns the page's elements whose ids are a prefix, a dash and one of these names, by name.
export function partsOf(prefix, names) {
    return Object.fromEntries(names.map((name) => [name, byId(`${prefix}-${name}`)]));
}

// Makes an element, as in make('button', {className: 'link', 'aria-label': 'x'}, 'text', child,
// ...). Names with a dash are attributes, other names are properties.
export function make(tag, properties = {}, ...children) {
    const element = document.createElement(tag);
    for (const [name, value] of Object.entries(properties)) {
        if (name.includes('-')) {
            element.setAttribute(name, value);
        } else {
            element[name] = value;
        }
    }
    element.append(...children);
    return element;
}

const leftBehind = new WeakSet();

// Enables or disables a button. If a button loses the focus because it is disabled, it gets the
// focus back when it is enabled, unless another element has the focus by then. So a user of the
// keyboard can press the button again.
export function enable(button, isEnabled) {
    if (!isEnabled && document.activeElement === button) {
        leftBehind.add(button);
    }
    button.disabled = !isEnabled;
    if (isEnabled && leftBehind.delete(button) && isNowhere(document.activeElement)) {
        button.focus();
    }
}

function isNowhere(element) {
    return element === null || element === document.body || element.disabled === true;
}

// Calls `act()`, which makes the rows of a list anew. If an element in a row had the focus, the element
// at its place in the new row gets it: the row with the same `keyOf(row)`, and the same first class.
export function keepFocusIn(list, keyOf, act) {
    const { activeElement: focused } = document;
    const isInside = focused !== list && list.contains(focused);
    const key = isInside ? keyOf(focused.closest('li')) : null;
    act();
    if (isInside && !focused.isConnected) {
        const row = [...list.children].find((one) => keyOf(one) === key);
        row?.querySelector(`.${focused.classList[0]}`)?.focus();
    }
}

// Returns nodes that show a text, with the words between backticks as code.
export function prose(text) {
    return text.split('`').map((part, i) => (i % 2 === 1 ? make('code', {}, part) : part));
}

const counts = new Intl.NumberFormat('en');

// Formats a count as in 1,234,567.
export function formatCount(value) {
    return counts.format(value);
}

// Formats a count with its noun as in "1 hole" or "1,234 holes".
export function formatNumberOf(count, one, many = `${one}s`) {
    return `${formatCount(count)} ${count === 1 ? one : many}`;
}

const about = new Intl.NumberFormat('en', { notation: 'compact', maximumFractionDigits: 1 });

// Formats a count as in 12,345 or 1.2M, where space is short.
export function formatAbout(value) {
    return value < 100000 ? formatCount(value) : about.format(value);
}

// Formats a measure with at most `digits` significant digits. `value` is null if the server's
// computation overflowed, because JSON has no infinity.
export function formatMeasure(value, digits = 6) {
    if (value === null) {
        return 'too large';
    }
    return String(Number(value.toPrecision(digits)));
}
