// jobs.js - requests that may take long: if the server answers with a job, the page waits for it.
//
// If `work` is not null, the server may run any such request as a job. Then work.begin(cancel) is called
// once, with a function that cancels the job, and work.show(job) with each state of the job.

import { Problem, cancelled, problemOf } from './problem.js';
import { getJson, meshOf, request } from './request.js';

// Milliseconds between requests for the state of a job: JOB_SOON at first, then each time twice as
// many, at most JOB_LATEST.
const JOB_SOON = 60;

const JOB_LATEST = 1000;

// Waits for a job: returns its result or throws its problem. `mesh` is the id of the mesh that the job
// is about, or null.
export async function finish(first, work, mesh = null) {
    const path = `v1/jobs/${first.id}`;
    let stop = () => {};
    const stopped = () => new Promise((resolve) => {
        stop = resolve;
    });
    work?.begin(async () => {
        // A job that has ended is not cancelled: DELETE would then delete its result.
        if ((await getJson(path)).finished === null) {
            await request(path, { method: 'DELETE' });
        }
        stop();
    });
    let job = first;
    for (let delay = JOB_SOON; job.finished === null; delay = Math.min(2 * delay, JOB_LATEST)) {
        work?.show(job);
        await Promise.race([stopped(), new Promise((resolve) => setTimeout(resolve, delay))]);
        job = await getJson(path);
    }
    if (job.state === 'cancelled') {
        throw cancelled();
    }
    if (job.state === 'failed') {
        throw job.problem ? new Problem({ ...job.problem, mesh }) : problemOf(job.status, '');
    }
    return job.result ?? null;
}

// Reads an answer that may take long to compute: if the server answers with a job, waits for it.
export async function readLong(path, signal, work = null) {
    const answer = await request(path, { signal });
    return answer.status === 202 ? finish(await answer.json(), work, meshOf(path)) : answer.json();
}

// Sends a POST and returns the JSON of the answer, or null if it has no body. If the server answers
// with a job, because the request takes long, waits for the job and returns its result.
export async function postJson(path, body, work = null, signal = undefined) {
    const headers = { 'Content-Type': 'application/json' };
    if (work !== null) {
        headers.Prefer = 'respond-async';
    }
    const answer = await request(path, {
        method: 'POST',
        headers,
        body: JSON.stringify(body),
        signal,
    });
    if (answer.status === 204) {
        return null;
    }
    return answer.status === 202 ? finish(await answer.json(), work, meshOf(path)) : answer.json();
}
