#include "api/request/gather.h"

/* The number of bytes that are read at a time. After each piece the reader stops if the work was
 * cancelled. */
enum { PIECE = 256 * 1024 };

static bool read_piece(api_exchange *x, bool *ended)
{
    api_text *text = &x->text;
    char *room = api_text_room(text, PIECE);
    if (room == NULL) {
        return api_fail_memory(x);
    }
    int64_t got = x->answer.read(x->answer.context, room, PIECE);
    if (got < 0) {
        return api_fail_memory(x);
    }
    text->length += (size_t)got;
    *ended = got == 0;
    return true;
}

void api_gather(api_exchange *x)
{
    api_answer *a = &x->answer;
    if (a->read == NULL || x->blob.self != NULL || x->problem.code != HE_OK) {
        return;
    }
    he_error err = {0};
    bool ended = false;
    uint64_t expected = a->length < 0 ? 0 : (uint64_t)a->length;
    api_text_empty(&x->text);
    he_progress_span(&x->progress, 1);
    if (he_progress_phase(&x->progress, "writing", 1, &err) != HE_OK) {
        api_fail_core(x, &err);
        return;
    }
    /* Memory for one piece more than the answer is reserved, because the last call of `read`, which
     * finds the end, needs space, too. */
    if (expected > 0 && api_text_room(&x->text, (size_t)expected + PIECE) == NULL) {
        api_fail_memory(x);
        return;
    }
    while (!ended && read_piece(x, &ended)) {
        if (he_progress_step(&x->progress, x->text.length, expected, &err) != HE_OK) {
            api_fail_core(x, &err);
            return;
        }
    }
    a->read = NULL;
    a->bytes = x->text.bytes;
    a->length = (int64_t)x->text.length;
}
