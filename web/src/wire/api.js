// api.js - all requests that the page sends to the server, as one module. Each of the modules below has
// the requests about one thing; request.js sends them, and jobs.js waits for those that take long.

export { Problem } from './problem.js';
export { sendAny } from './request.js';
export * from './service.js';
export * from './meshes.js';
export * from './upload.js';
export * from './elements.js';
export * from './columns.js';
export * from './attributes.js';
export * from './arrays.js';
export * from './listen.js';
export * from './edits.js';
