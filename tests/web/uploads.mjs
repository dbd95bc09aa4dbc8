// uploads.mjs - counts the bytes that a page gives to the graphics memory.

// Runs in the page before its scripts: window.uploaded is the number of bytes so far.
export function countUploads() {
    window.uploaded = 0;
    const { prototype } = WebGL2RenderingContext;
    for (const name of ['bufferData', 'bufferSubData', 'texImage2D', 'texSubImage2D']) {
        const original = prototype[name];
        prototype[name] = function (...values) {
            const data = values.findLast((one) => ArrayBuffer.isView(one) || one instanceof ArrayBuffer);
            if (name.startsWith('tex')) {
                // width x height texels of 16 bytes: all textures of the mesh have such texels
                const [width, height] = values.slice(name === 'texImage2D' ? 3 : 4);
                window.uploaded += data === undefined ? 0 : 16 * width * height;
            } else {
                window.uploaded += data?.byteLength ?? 0;
            }
            return original.apply(this, values);
        };
    }
}
