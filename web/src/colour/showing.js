// showing.js - decides how a column of numbers is shown: with which map of colours, and over which
// range. Pure.

// Returns {map, maps, categories, usual, range}: the map, those that the user can choose, the categories
// or null, and the usual and the present range. `isIndex` is as in sources.js; `map` and `range` are what
// the user has chosen, or null.
export function showingOf(column, isIndex, map, range) {
    const isSplit = column.count > 0 && column.least < 0 && column.most > 0;
    const categories = isIndex || column.isWhole || map === 'categorical' ? column.categories : null;
    const maps = ['sequential', 'diverging', ...(categories === null ? [] : ['categorical'])];
    const usualMap = isIndex && categories !== null ? 'categorical' : isSplit ? 'diverging' : 'sequential';
    const shown = maps.includes(map) ? map : usualMap;
    const usual = column.usualRange(shown === 'diverging' && isSplit);
    return { map: shown, maps, categories, usual, range: range ?? usual };
}
