// when.js - says in words when something was, the shorter the nearer it is. Pure.

const MONTHS = 'Jan Feb Mar Apr May Jun Jul Aug Sep Oct Nov Dec'.split(' ');

const two = (number) => `${number}`.padStart(2, '0');

// Returns whether two dates are on days of the reader's calendar that are `apart` days from each other.
function areDaysApart(early, late, apart) {
    const day = new Date(late.getFullYear(), late.getMonth(), late.getDate() - apart);
    return day.toDateString() === early.toDateString();
}

// Returns when `date` was for a reader at the time `now`, both of them Dates: "14:03" for today,
// "yesterday 14:03", "27 Nov 14:03", or "27 Nov 2025" for another year.
export function wordsOfTime(date, now) {
    const clock = `${two(date.getHours())}:${two(date.getMinutes())}`;
    if (areDaysApart(date, now, 0)) {
        return clock;
    }
    if (areDaysApart(date, now, 1)) {
        return `yesterday ${clock}`;
    }
    const day = `${date.getDate()} ${MONTHS[date.getMonth()]}`;
    const isThisYear = date.getFullYear() === now.getFullYear();
    return isThisYear ? `${day} ${clock}` : `${day} ${date.getFullYear()}`;
}
