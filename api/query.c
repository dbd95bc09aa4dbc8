/* POST .../query: many questions of one revision. A failed one is its problem object, in its place;
 * it stops no other. */
#include "api/handlers.h"

#include "api/question.h"

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
            good = !a->spent && x->problem.code != HE_NO_MEMORY && write_problem(x, &scratch);
        }
    }
    api_out_array_end(&x->out);
    api_out_object_end(&x->out);
    api_text_clear(&scratch);
    return good;
}

/* --- octets --- */

typedef struct octets {
    he_dense dense; /* little-endian */
    size_t sent;    /* bytes */
} octets;

static void free_octets(void *stream)
{
    octets *o = stream;
    he_dense_clear(&o->dense);
    he_mem_free(o);
}

/* Copy what of `ids` lies at `*at` bytes, which is moved on; or move `*at` past them. */
static size_t copy_ids(const he_ids *ids, size_t *at, char *buffer, size_t size)
{
    size_t bytes = ids->count * sizeof *ids->ids;
    if (*at >= bytes) {
        *at -= bytes;
        return 0;
    }
    size_t length = bytes - *at < size ? bytes - *at : size;
    memcpy(buffer, (const char *)ids->ids + *at, length);
    *at = 0;
    return length;
}

static int64_t read_octets(void *stream, char *buffer, size_t size)
{
    octets *o = stream;
    size_t at = o->sent;
    size_t length = copy_ids(&o->dense.offsets, &at, buffer, size);
    length += copy_ids(&o->dense.ids, &at, buffer + length, size - length);
    o->sent += length;
    return (int64_t)length;
}

/* Nothing where the machine has this order already: compilers see that. */
static void order_bytes(he_ids *list)
{
    for (size_t i = 0; i < list->count; i++) {
        uint32_t id = list->ids[i];
        const unsigned char bytes[4] = {(unsigned char)id, (unsigned char)(id >> 8),
                                        (unsigned char)(id >> 16), (unsigned char)(id >> 24)};
        memcpy(&list->ids[i], bytes, sizeof bytes);
    }
}

static void answer_octets(api_exchange *x, api_asker *a, const api_in *question)
{
    octets *o = he_mem_zero(1, sizeof *o);
    if (o == NULL) {
        api_fail_memory(x);
        return;
    }
    if (!api_question_dense(a, question, &o->dense)) {
        he_mem_free(o);
        return;
    }
    order_bytes(&o->dense.offsets);
    order_bytes(&o->dense.ids);
    size_t length = (o->dense.offsets.count + o->dense.ids.count) * sizeof(uint32_t);
    api_answer_stream(x, 200, "application/octet-stream", (int64_t)length, read_octets, o,
                      free_octets);
}

/* --- which --- */

static void answer(api_exchange *x, api_asker *a)
{
    api_in queries, first;
    if (!api_in_only(&x->root, members) || !api_in_need(&x->root, "queries", &queries) ||
        !api_in_array(&queries, 0, API_MAX_QUERIES)) {
        return;
    }
    if (strcmp(x->media_out, "application/octet-stream") == 0) {
        bool dense = api_in_first(&queries, &first) && api_question_is_dense(&first) &&
                     api_in_count(&queries) == 1;
        if (dense) {
            answer_octets(x, a, &first);
            return;
        }
        if (api_media_choose(api_header_of(x, "Accept"), json_only) < 0) {
            api_fail(x, API_NOT_ACCEPTABLE, "octets answer one question about many elements");
            x->problem.supported = json_only;
            return;
        }
    }
    if (answer_each(x, a, &queries)) {
        api_answer_json(x, 200);
    }
}

void api_query_post(api_exchange *x)
{
    api_asker_run(x, api_query_post, answer);
}
