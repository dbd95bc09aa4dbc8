// view_panel.mjs - what tests of the look of the view share: they open its panel, set looks, and know
// the colours in which looks are drawn.

export async function openView(page) {
    await page.getByRole('button', { name: 'View', exact: true }).click();
    await page.locator('#view-panel').waitFor();
}

// Waits until the page has computed what the look needs, and until everything is on the screen.
export function waitForDrawing(page) {
    return page.evaluate(async () => {
        const frame = () => new Promise((resolve) => requestAnimationFrame(resolve));
        const { look } = document.getElementById('canvas');
        for (let i = 0; i < 3 || look.isBusy; i++) {
            await frame();
        }
        await frame();
        await frame();
    });
}

// Sets the look as a link would, and waits until it is drawn.
export async function setLook(page, state) {
    await page.evaluate((wanted) => {
        const { look } = document.getElementById('canvas');
        look.state = { ...look.state, ...wanted };
    }, state);
    await waitForDrawing(page);
}

export const lookOf = (page) => page.evaluate(() => document.getElementById('canvas').look.state);

// Whether a pixel has one of the colours of gl/look_shaders.js or gl/cut.js, with a tolerance.
export const isCap = ([r, g, b]) => g > r + 30 && b > r + 15 && g > b + 8 && g < 190;
export const isClay = ([r, g, b]) => r > g + 20 && g >= b - 12;
export const isMarkedBack = ([r, g, b]) => r > g + 50 && r > b + 40 && g < 80;
export const isPaper = ([r, g, b]) => r > 230 && g > 233 && b > 236;
