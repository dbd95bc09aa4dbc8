/* query.c - POST .../query: answers many questions about one revision. Each answer has the index of
 * its question. The answer to a failed question is a problem object; the other questions are still
 * answered. */
#include "api/request/handlers.h"

#include "api/ask/question.h"

#include <string.h>

static const char *const members[] = {"queries", NULL};
static const char *const json_only[] = {"application/json", NULL};

static bool write_problem(api_exchange *x, api_text *scratch)
{
    api_text_empty(scratch);
    api_problem_write(&x->problem, NULL, scratch);
    x->problem = (api_problem){0};
    if (scratch->failed) {
        return api_fail_memory(x);
    }
    api_out_raw(&x->out, scratch->bytes, scratch->length);
    return true;
}

/* Returns true if the problem is about one question rather than about the whole request. */
static bool is_of_question(const api_problem *problem)
{
    return problem->code != HE_NO_MEMORY && problem->code != HE_CANCELLED;
}

static bool answer_each(api_exchange *x, api_asker *a, const api_in *queries)
{
    api_text scratch = {0};
    api_in question;
    bool good = true;
    api_out_object_begin(&x->out);
    api_out_key_u64(&x->out, "revision", a->revision);
    api_out_key(&x->out, "results");
    api_out_array_begin(&x->out);
    for (bool more = api_in_first(queries, &question); more && good;
         more = api_in_next(&question)) {
        if (!api_question_ask(a, &question)) {
            good = !a->spent && is_of_question(&x->problem) && write_problem(x, &scratch);
        }
    }
    api_out_array_end(&x->out);
    api_out_object_end(&x->out);
    api_text_clear(&scratch);
    return good;
}

/* --- binary answers --- */

/* A binary answer consists of blocks of bytes; all values are little-endian, and all but doubles
 * have 32 bits. The neighbours of n elements are n + 1 offsets, and then the ids. A measure of n
 * elements is n doubles, with NaN in place of null. If the question is about "all", the ids of the
 * n elements follow, and at the end the number n, from which a reader knows where the blocks
 * begin. */
enum { OFFSETS, VALUES = OFFSETS, IDS, ELEMENTS, COUNT, BLOCKS };

typedef struct octets {
    he_dense dense;
    api_measured measured;
    api_named named; /* of `dense` */
    uint32_t count;
    struct {
        const void *bytes;
        size_t length;
    } blocks[BLOCKS];
    size_t sent;
} octets;

static void free_octets(void *stream)
{
    octets *o = stream;
    he_dense_clear(&o->dense);
    he_ids_clear(&o->named.ids);
    api_measured_clear(&o->measured);
    he_mem_free(o);
}

static int64_t read_octets(void *stream, char *buffer, size_t size)
{
    octets *o = stream;
    size_t at = o->sent, written = 0;
    for (int i = 0; i < BLOCKS; i++) {
        size_t length = o->blocks[i].length;
        if (at >= length) {
            at -= length;
            continue;
        }
        size_t part = length - at < size - written ? length - at : size - written;
        memcpy(buffer + written, (const char *)o->blocks[i].bytes + at, part);
        written += part;
        at = 0;
    }
    o->sent += written;
    return (int64_t)written;
}

/* Converts ids to little-endian; on a little-endian machine compilers reduce this to nothing. */
static void order_ids(octets *o, int block, uint32_t *ids, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const uint32_t id = ids[i];
        const unsigned char bytes[4] = {(unsigned char)id, (unsigned char)(id >> 8),
                                        (unsigned char)(id >> 16), (unsigned char)(id >> 24)};
        memcpy(&ids[i], bytes, sizeof bytes);
    }
    o->blocks[block].bytes = ids;
    o->blocks[block].length = count * sizeof *ids;
}

static void order_values(octets *o, double *values, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        uint64_t bits;
        unsigned char bytes[8];
        memcpy(&bits, &values[i], sizeof bits);
        for (unsigned k = 0; k < 8; k++) {
            bytes[k] = (unsigned char)(bits >> 8 * k);
        }
        memcpy(&values[i], bytes, sizeof bytes);
    }
    o->blocks[VALUES].bytes = values;
    o->blocks[VALUES].length = count * sizeof *values;
}

static bool fill_octets(octets *o, api_asker *a, const api_in *question)
{
    const bool measured = api_measure_is_dense(question);
    if (measured ? !api_measure_dense(a, question, &o->measured)
                 : !api_question_dense(a, question, &o->dense, &o->named)) {
        return false;
    }
    const api_named *named = measured ? &o->measured.named : &o->named;
    if (measured) {
        order_values(o, o->measured.values, o->measured.count);
    } else {
        order_ids(o, OFFSETS, o->dense.offsets.ids, o->dense.offsets.count);
        order_ids(o, IDS, o->dense.ids.ids, o->dense.ids.count);
    }
    if (named->all) {
        o->count = (uint32_t)named->ids.count;
        order_ids(o, ELEMENTS, named->ids.ids, named->ids.count);
        order_ids(o, COUNT, &o->count, 1);
    }
    return true;
}

static void answer_octets(api_exchange *x, api_asker *a, const api_in *question)
{
    octets *o = he_mem_zero(1, sizeof *o);
    if (o == NULL) {
        api_fail_memory(x);
        return;
    }
    if (!fill_octets(o, a, question) || a->reads_only) {
        free_octets(o);
        return;
    }
    int64_t length = 0;
    for (int i = 0; i < BLOCKS; i++) {
        length += (int64_t)o->blocks[i].length;
    }
    const api_stream stream = {length, read_octets, o, free_octets};
    api_answer_stream(x, 200, "application/octet-stream", &stream);
}

/* --- the handler of the route --- */

static void answer(api_exchange *x, api_asker *a)
{
    api_in queries, first;
    if (!api_in_only(&x->root, members) || !api_in_need(&x->root, "queries", &queries) ||
        !api_in_array(&queries, 0, API_MAX_QUERIES)) {
        return;
    }
    if (strcmp(x->media_out, "application/octet-stream") == 0) {
        bool dense = api_in_first(&queries, &first) && api_in_count(&queries) == 1 &&
                     (api_question_is_dense(&first) || api_measure_is_dense(&first));
        if (dense) {
            answer_octets(x, a, &first);
            return;
        }
        if (api_media_choose(x->request.headers[API_HEADER_ACCEPT], json_only) < 0) {
            api_fail(x, API_NOT_ACCEPTABLE,
                     "application/octet-stream can carry the answer to only one question, which "
                     "must be about a list of elements or \"all\"");
            x->problem.supported = json_only;
            return;
        }
    }
    /* The problem of a failed question is written in place of its answer. */
    if (!a->reads_only && answer_each(x, a, &queries)) {
        api_answer_json(x, 200);
    }
}

bool api_query_cost(api_exchange *x, const he_mesh *mesh, api_cost *out)
{
    (void)mesh;
    (void)out; /* the cost is not estimated: it is charged while the questions are answered */
    return !api_wants_job(x, 0) || api_asker_read(x, answer);
}

void api_query_post(api_exchange *x)
{
    api_asker_run(x, answer);
}
