#include "api/request/content_encoding.h"

#include <string.h>

bool api_content_encoding_body(api_exchange *x)
{
    const char *coding = x->request.headers[API_HEADER_CONTENT_ENCODING];
    if (!api_coding_of_body(coding, &x->coding_in)) {
        api_fail(x, API_UNSUPPORTED_ENCODING,
                 "the content coding \"%.60s\" is not supported; use one of %s, or identity",
                 coding, api_codings_list);
        x->problem.supported = api_codings_taken;
        return false;
    }
    return true;
}

static const api_codings only_identity = {.allowed = {[API_IDENTITY] = true}, .best = API_IDENTITY};

/* Returns true if the route answers with a stream of events, which are small and must not wait in a
 * compressor. */
static bool is_stream(const api_route *route)
{
    return route->produces[0] != NULL && strcmp(route->produces[0], "text/event-stream") == 0;
}

bool api_content_encoding_accept(api_exchange *x)
{
    static const char *const identity[] = {"identity", NULL};
    const char *accept = x->request.headers[API_HEADER_ACCEPT_ENCODING];
    bool plain = x->service->options.plain_answers || is_stream(x->route);
    bool good = api_coding_choose(accept, &x->codings);
    if (plain) {
        good = x->codings.allowed[API_IDENTITY];
        x->codings = only_identity;
    }
    if (!good) {
        api_fail(x, API_NOT_ACCEPTABLE,
                 "Accept-Encoding \"%.100s\" allows none of the content codings of the answer",
                 accept);
        x->problem.supported = plain ? identity : api_codings_taken;
    }
    return good;
}

bool api_content_encoding_varies(const api_exchange *x)
{
    return !x->service->options.plain_answers && x->answer.live == NULL && x->answer.status != 204;
}

/* --- compressing the answer --- */

static api_header *find_header(api_exchange *x, const char *name)
{
    for (size_t i = 0; i < x->answer.header_count; i++) {
        if (strcmp(x->answer.headers[i].name, name) == 0) {
            return &x->answer.headers[i];
        }
    }
    return NULL;
}

/* Returns true if the answer has a media type that is compressed already. */
static bool is_packed(api_exchange *x)
{
    static const char *const types[] = {"image/png", "image/jpeg", "image/webp", "font/woff2"};
    const api_header *type = find_header(x, "Content-Type");
    for (size_t i = 0; type != NULL && i < sizeof types / sizeof *types; i++) {
        if (strcmp(type->value, types[i]) == 0) {
            return true;
        }
    }
    return false;
}

static bool is_worth_it(api_exchange *x)
{
    const api_answer *a = &x->answer;
    if (!api_content_encoding_varies(x) || x->codings.best == API_IDENTITY || a->status == 304 ||
        (a->read == NULL && a->length == 0)) {
        return false;
    }
    bool small = a->length >= 0 && a->length <= API_COMPRESS_FROM;
    return !x->codings.allowed[API_IDENTITY] || (!small && !a->is_dense && !is_packed(x));
}

/* Adds the header Content-Encoding and the suffix of the coding to the ETag. Returns false, with
 * nothing added, when memory is out. */
static bool name_coding(api_exchange *x)
{
    api_header *tag = find_header(x, "ETag");
    if (tag != NULL) {
        char coded[API_ETAG];
        api_etag_code(tag->value, x->codings.best, coded);
        const char *copy = api_arena_copy(&x->arena, coded, strlen(coded));
        if (copy == NULL) {
            return false;
        }
        tag->value = copy;
    }
    x->answer.headers[x->answer.header_count++] =
        (api_header){"Content-Encoding", api_coding_name(x->codings.best)};
    return true;
}

/* Compresses the whole answer now, so that its length is known. */
static void code_whole(api_exchange *x, size_t length)
{
    /* The size of the buffer: more than zlib or zstd needs in the worst case. */
    size_t room = length + length / 4 + 512;
    x->coded = he_mem_alloc(room);
    if (x->coded == NULL || !api_compressor_begin(x->compressor)) {
        return;
    }
    int64_t coded = api_compressor_read(x->compressor, x->coded, room);
    bool shorter = coded >= 0 && ((size_t)coded < length || !x->codings.allowed[API_IDENTITY]);
    if (shorter && name_coding(x)) {
        x->answer.bytes = x->coded;
        x->answer.length = coded;
    }
}

/* Replaces a body that is kept in memory (kept.h) by its compressed form, if that is shorter or the
 * client accepts no other. */
static void code_kept(api_exchange *x)
{
    api_answer *a = &x->answer;
    const char *bytes;
    size_t length;
    if (api_kept_coded(x->kept, x->codings.best, &bytes, &length) &&
        ((int64_t)length < a->length || !x->codings.allowed[API_IDENTITY]) && name_coding(x)) {
        a->bytes = bytes;
        a->length = (int64_t)length;
    }
}

void api_content_encoding_answer(api_exchange *x)
{
    api_answer *a = &x->answer;
    const char *bytes;
    size_t length;
    if (!is_worth_it(x) || a->header_count == API_ANSWER_HEADERS) {
        return;
    }
    if (x->kept != NULL) {
        code_kept(x);
        return;
    }
    api_plain plain = {.bytes = a->bytes, .read = a->read, .context = a->context};
    plain.length = plain.bytes == NULL ? 0 : (size_t)a->length;
    x->compressor = api_compressor_new(x->codings.best, &plain);
    if (x->compressor == NULL) {
        return;
    }
    if (api_compressor_whole(x->compressor, &bytes, &length)) {
        a->read = NULL;
        a->bytes = bytes;
        a->length = (int64_t)length;
        if (length > API_COMPRESS_FROM || !x->codings.allowed[API_IDENTITY]) {
            code_whole(x, length);
        }
        return;
    }
    /* The compressor has read part of the body already, so the rest must come from it even if it
     * cannot compress: then it passes the body on unchanged. */
    a->read = api_compressor_read;
    a->context = x->compressor;
    a->bytes = NULL;
    if (api_compressor_begin(x->compressor) && name_coding(x)) {
        a->length = -1;
        a->slow = true;
    } else {
        api_compressor_give_up(x->compressor);
    }
}
