// file_reader.mjs - the part of a browser's FileReader that GLTFExporter uses.

export class FileReader {
    readAsArrayBuffer(blob) {
        blob.arrayBuffer().then((bytes) => {
            this.result = bytes;
            this.onloadend();
        });
    }
}
