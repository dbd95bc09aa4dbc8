// dom.js - building elements. Text is always text: nothing here reads HTML, so a mesh may be named
// anything.

// What the page has under an id.
export function byId(id) {
    return document.getElementById(id);
}

// make('button', {className: 'link', 'aria-label': 'x'}, 'text', child, ...). Names with a dash are
// attributes, others are properties.
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

// Enable a button, or disable it. One that loses the focus by that has it again afterwards, unless
// that has gone elsewhere: who works by keys presses it again.
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

// What is between backquotes is code.
export function prose(text) {
    return text.split('`').map((part, i) => (i % 2 === 1 ? make('code', {}, part) : part));
}

const counts = new Intl.NumberFormat('en');

// 1,234,567
export function formatCount(value) {
    return counts.format(value);
}

const about = new Intl.NumberFormat('en', { notation: 'compact', maximumFractionDigits: 1 });

// 12,345 or 1.2M, where room is short.
export function formatAbout(value) {
    return value < 100000 ? formatCount(value) : about.format(value);
}

// So many significant digits at most, for what is measured. JSON has null where a double
// overflowed.
export function formatMeasure(value, digits = 6) {
    if (value === null) {
        return 'too large';
    }
    return String(Number(value.toPrecision(digits)));
}
