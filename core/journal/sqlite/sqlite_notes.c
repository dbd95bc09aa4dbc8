/* sqlite_notes.c - writes and reads notes: states of jobs, and Idempotency-Keys of requests that
 * changed nothing. In the queue, a note is a group of records that has no records. So a note has a
 * position in the order of records, and if a note is lost, all records after it are lost, too. The
 * states of a job in the database are:
 *
 *     accepted ----> done             written in the transaction of the records that the job made
 *         |            |
 *         +------------+---> ended, with its answer ---> deleted by its owner or because of its
 *                                                        age */
#include "journal/sqlite/sqlite_state.h"

#include <string.h>

/* --- writing to the queue --- */

enum { JOB_TEXTS = 5 + ST_JOB_HEADERS };

/* Lists the members of a job that are texts. */
static void texts_of(st_job *job, const char **out[JOB_TEXTS])
{
    out[0] = &job->operation;
    out[1] = &job->phase;
    out[2] = &job->mesh;
    out[3] = &job->location;
    out[4] = &job->holder;
    for (size_t i = 0; i < ST_JOB_HEADERS; i++) {
        out[5 + i] = &job->headers[i];
    }
}

/* Returns how many bytes a copy of the job's texts and body takes. */
static size_t bytes_of(const st_job *job)
{
    st_job copy = *job;
    const char **texts[JOB_TEXTS];
    size_t bytes = job->body == NULL ? 0 : job->length + 1;
    texts_of(&copy, texts);
    for (size_t i = 0; i < JOB_TEXTS; i++) {
        bytes += strlen(*texts[i]) + 1;
    }
    return bytes;
}

static void copy_job(const st_job *job, unsigned char *at, st_job *out)
{
    const char **texts[JOB_TEXTS];
    *out = *job;
    texts_of(out, texts);
    for (size_t i = 0; i < JOB_TEXTS; i++) {
        const size_t size = strlen(*texts[i]) + 1;
        *texts[i] = memcpy(at, *texts[i], size);
        at += size;
    }
    if (job->body != NULL) {
        out->body = memcpy(at, job->body, job->length);
    }
}

st_status st_sqlite_note(void *context, const st_note *note, uint64_t *position)
{
    st_sqlite *self = context;
    st_room *taken;
    const st_room_need need = {.bytes = note->job == NULL ? 0 : bytes_of(note->job),
                               .freeing = note->forgotten != NULL};
    const st_status status = st_sqlite_reserve(self, &need, &taken);
    if (status != ST_OK) {
        return status;
    }
    st_sqlite_room *room = (st_sqlite_room *)taken;
    if (note->job != NULL) {
        room->job_word = ST_JOB_IS;
        copy_job(note->job, taken->bytes, &room->job);
    } else if (note->forgotten != NULL) {
        room->job_word = ST_JOB_LEAVES;
        st_copy_text(room->job.id, note->forgotten, ST_JOB_ID);
    } else {
        st_room_key(room, note->kept);
    }
    *position = st_room_push(self, room, 1);
    return ST_OK;
}

/* --- writing to the table --- */

static st_sql make_row(st_sqlite *self, const st_job *job)
{
    const double now = job->finished > job->created ? job->finished : job->created;
    st_sql outcome =
        st_db_do(&self->db, ST_SQL_JOB_MAKE, "tiitttttddddiittttbi", job->id, job->number,
                 (uint64_t)job->state, job->operation, job->phase, job->mesh, job->location,
                 job->holder, job->progress, job->created, job->started, job->finished,
                 (int64_t)job->status, (uint64_t)job->shown, job->headers[ST_JOB_TYPE],
                 job->headers[ST_JOB_DISPOSITION], job->headers[ST_JOB_TAG],
                 job->headers[ST_JOB_WARNINGS], job->body, job->length, (uint64_t)st_job_sum(job));
    /* Whenever a job is stored, up to two expired jobs are deleted. */
    return outcome == ST_SQL_DONE ? st_db_do(&self->db, ST_SQL_JOBS_TRIM, "d", now - ST_JOB_SECONDS)
                                  : outcome;
}

/* Marks a job as done, in the transaction that writes the records that the job made. Nothing is
 * done if the job is not stored or its row is damaged. */
static st_sql end_row(st_sqlite *self, const st_job *work)
{
    sqlite3_stmt *s;
    st_job job;
    st_sql outcome = st_db_find(&self->db, ST_SQL_JOB, &s, "t", work->id);
    if (outcome != ST_SQL_ROW) {
        return outcome;
    }
    const bool good = st_job_read(s, &job);
    job.state = ST_JOB_DONE;
    job.mesh = work->mesh;
    job.progress = 1;
    job.finished = work->finished;
    job.status = work->status;
    const uint32_t sum = good ? st_job_sum(&job) : 0;
    st_db_reset(s);
    return good ? st_db_do(&self->db, ST_SQL_JOB_DONE, "titddii", work->id, (uint64_t)job.state,
                           job.mesh, job.progress, job.finished, (int64_t)job.status, (uint64_t)sum)
                : ST_SQL_DONE;
}

st_sql st_notes_add_job(st_sqlite *self, const st_sqlite_room *room)
{
    switch (room->job_word) {
    case ST_JOB_WORK:
        return end_row(self, &room->job);
    case ST_JOB_IS:
        return make_row(self, &room->job);
    case ST_JOB_LEAVES:
        return st_db_do(&self->db, ST_SQL_JOB_DELETE, "t", room->job.id);
    case ST_JOB_UNNAMED:
        break;
    }
    return ST_SQL_DONE;
}

/* --- reading the table --- */

/* Reads all stored jobs. A row with a wrong checksum is skipped. */
st_status st_sqlite_jobs(void *context, st_take_job *take, void *to)
{
    st_sqlite *self = context;
    sqlite3_stmt *s = NULL;
    st_job job;
    bool taken = true;
    st_queue_settle(self);
    pthread_mutex_lock(&self->cards_lock);
    int code = sqlite3_prepare_v2(
        self->cards.handle, "SELECT " ST_JOB_COLUMNS " FROM job ORDER BY number", -1, &s, NULL);
    while (code == SQLITE_OK && taken && (code = sqlite3_step(s)) == SQLITE_ROW) {
        code = SQLITE_OK;
        taken = !st_job_read(s, &job) || take(to, &job);
    }
    const st_sql outcome = code == SQLITE_OK ? ST_SQL_DONE : st_db_outcome(&self->cards, code);
    sqlite3_finalize(s);
    pthread_mutex_unlock(&self->cards_lock);
    if (!taken || outcome == ST_SQL_NO_MEMORY) {
        return ST_NO_MEMORY;
    }
    return outcome == ST_SQL_DONE ? ST_OK : ST_FAILED;
}
