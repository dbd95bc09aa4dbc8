#include "api/token/token_file.h"

#include "base/mem.h"
#include "base/siphash.h"
#include "system/random.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

/* One field of a line, borrowed from the bytes of the file. */
typedef struct word {
    const char *at;
    size_t length;
} word;

typedef struct reader {
    size_t line;
    char *message;
} reader;

static bool fail(const reader *r, const char *format, ...) __attribute__((format(printf, 2, 3)));
static bool fail(const reader *r, const char *format, ...)
{
    int used = r->line == 0 ? 0 : snprintf(r->message, API_TOKENS_MESSAGE, "line %zu: ", r->line);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(r->message + used, API_TOKENS_MESSAGE - (size_t)used, format, arguments);
    va_end(arguments);
    return false;
}

/* --- reading the fields of a line --- */

static bool is_id_character(char c)
{
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '.' ||
           c == '_' || c == '-';
}

static bool is_of_ids(word w, size_t most)
{
    bool good = w.length > 0 && w.length <= most;
    for (size_t i = 0; good && i < w.length; i++) {
        good = is_id_character(w.at[i]);
    }
    return good;
}

bool api_token_is_name(const char *text, size_t length)
{
    const char *const mark = "hedge_";
    bool is_token = length >= strlen(mark) && memcmp(text, mark, strlen(mark)) == 0;
    return !is_token && is_of_ids((word){text, length}, API_TOKEN_NAME);
}

bool api_role_find(const char *text, size_t length, api_role *out)
{
    for (api_role role = API_ROLE_ADMIN; role < API_ROLE_OPEN; role++) {
        const char *name = api_role_name(role);
        if (strlen(name) == length && memcmp(name, text, length) == 0) {
            *out = role;
            return true;
        }
    }
    return false;
}

static bool read_name(const reader *r, word w, api_token *out)
{
    if (!api_token_is_name(w.at, w.length)) {
        return fail(r,
                    "the name (field 1) is not 1 to %d of the characters A-Z a-z 0-9 . _ -, or is "
                    "itself a token",
                    API_TOKEN_NAME);
    }
    memcpy(out->name, w.at, w.length);
    unsigned char hash[API_TOKEN_HASH];
    api_token_hash(w.at, w.length, hash);
    memcpy(&out->rate_key, hash, sizeof out->rate_key);
    return true;
}

static bool read_role(const reader *r, word w, api_token *out)
{
    return api_role_find(w.at, w.length, &out->role) ||
           fail(r, "the role (field 2) is none of read, write, admin, metrics");
}

static int digit_of(char c)
{
    return c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

static bool read_hash(const reader *r, word w, api_token *out)
{
    static const char scheme[] = "sha256:";
    const size_t skipped = sizeof scheme - 1;
    bool good = w.length == skipped + 2 * API_TOKEN_HASH && memcmp(w.at, scheme, skipped) == 0;
    for (size_t i = 0; good && i < API_TOKEN_HASH; i++) {
        int high = digit_of(w.at[skipped + 2 * i]), low = digit_of(w.at[skipped + 2 * i + 1]);
        good = high >= 0 && low >= 0;
        out->hash[i] = (unsigned char)(good ? high << 4 | low : 0);
    }
    return good || fail(r, "the hash (field 3) is not \"sha256:\" followed by %d digits 0-9 a-f",
                        2 * API_TOKEN_HASH);
}

static bool read_prefixes(const reader *r, word w, api_token *out)
{
    const char *at = w.at, *end = w.at + w.length;
    do {
        const char *comma = memchr(at, ',', (size_t)(end - at));
        word prefix = {at, (size_t)((comma == NULL ? end : comma) - at)};
        if (out->prefix_count == API_TOKEN_PREFIXES) {
            return fail(r, "a token may have at most %d prefixes", API_TOKEN_PREFIXES);
        }
        if (!is_of_ids(prefix, API_TOKEN_PREFIX)) {
            return fail(r, "prefix %zu is not 1 to %d of the characters A-Z a-z 0-9 . _ -",
                        out->prefix_count + 1, API_TOKEN_PREFIX);
        }
        memcpy(out->prefixes[out->prefix_count++], prefix.at, prefix.length);
        at = comma == NULL ? NULL : comma + 1;
    } while (at != NULL);
    return true;
}

/* Returns true if the word has a shape such as "9999-99-99", where '9' stands for any digit. */
static bool has_shape(word w, const char *shape)
{
    bool good = w.length == strlen(shape);
    for (size_t i = 0; good && i < w.length; i++) {
        good = shape[i] == '9' ? w.at[i] >= '0' && w.at[i] <= '9' : w.at[i] == shape[i];
    }
    return good;
}

static int number_at(word w, size_t at, size_t digits)
{
    int value = 0;
    for (size_t i = at; i < at + digits; i++) {
        value = value * 10 + (w.at[i] - '0');
    }
    return value;
}

/* Reads the time at which a token expires. A date that does not exist is refused: timegm turns it
 * into another date. */
static bool read_expiry(const reader *r, word w, api_token *out)
{
    bool timed = has_shape(w, "9999-99-99T99:99:99Z");
    if (timed || has_shape(w, "9999-99-99")) {
        const struct tm asked = {.tm_year = number_at(w, 0, 4) - 1900,
                                 .tm_mon = number_at(w, 5, 2) - 1,
                                 .tm_mday = number_at(w, 8, 2),
                                 .tm_hour = timed ? number_at(w, 11, 2) : 0,
                                 .tm_min = timed ? number_at(w, 14, 2) : 0,
                                 .tm_sec = timed ? number_at(w, 17, 2) : 0};
        struct tm made = asked;
        time_t seconds = timegm(&made);
        if (made.tm_year == asked.tm_year && made.tm_mon == asked.tm_mon &&
            made.tm_mday == asked.tm_mday && made.tm_hour == asked.tm_hour &&
            made.tm_min == asked.tm_min && made.tm_sec == asked.tm_sec) {
            out->expires = (double)seconds;
            return true;
        }
    }
    return fail(
        r, "expires= needs a day or a time in UTC, such as 2027-01-01 or 2027-01-01T12:00:00Z");
}

/* The optional fields that may follow the first three fields of a line, each only once. */
static const struct {
    const char *name;
    bool (*read)(const reader *r, word w, api_token *out);
} settings[] = {{"prefix=", read_prefixes}, {"expires=", read_expiry}};
enum { SETTINGS = sizeof settings / sizeof *settings };

/* Returns the limit with this name, or API_LIMIT_COUNT if tokens have no such limit. */
static api_limit find_limit(word name)
{
    for (api_limit limit = 0; limit < API_LIMIT_COUNT; limit++) {
        const char *known = api_limit_name(limit);
        if (api_limit_is_of_token(limit) && strlen(known) == name.length &&
            memcmp(known, name.at, name.length) == 0) {
            return limit;
        }
    }
    return API_LIMIT_COUNT;
}

static bool read_limit(const reader *r, api_limit limit, word w, api_token *out)
{
    const bool bytes = api_limit_is_bytes(limit);
    const uint64_t most = bytes ? API_LIMIT_MOST_BYTES : API_LIMIT_MOST;
    uint64_t value = 0;
    if ((out->own_limits >> limit & 1) != 0) {
        return fail(r, "%s= is given twice", api_limit_name(limit));
    }
    if (!api_amount_parse(w.at, w.length, bytes, &value) || value > most) {
        return fail(r, "%s= needs a number from 0 to %llu%s", api_limit_name(limit),
                    (unsigned long long)most, bytes ? " (K, M, G and T are units)" : "");
    }
    out->own_limits |= 1U << limit;
    atomic_init(&out->limits[limit], value);
    return true;
}

static bool read_setting(const reader *r, word w, unsigned *seen, api_token *out)
{
    for (size_t i = 0; i < SETTINGS; i++) {
        size_t skipped = strlen(settings[i].name);
        if (w.length >= skipped && memcmp(w.at, settings[i].name, skipped) == 0) {
            if ((*seen >> i & 1) != 0) {
                return fail(r, "%s is given twice", settings[i].name);
            }
            *seen |= 1U << i;
            return settings[i].read(r, (word){w.at + skipped, w.length - skipped}, out);
        }
    }
    const char *equals = memchr(w.at, '=', w.length);
    const size_t name = equals == NULL ? 0 : (size_t)(equals - w.at);
    const api_limit limit = find_limit((word){w.at, name});
    return limit != API_LIMIT_COUNT
               ? read_limit(r, limit, (word){equals + 1, w.length - name - 1}, out)
               : fail(r, "a field after the hash must be prefix=, expires=, or a limit: requests=, "
                         "bytes=, jobs=, meshes= or mesh-bytes=");
}

/* --- reading a line --- */

static bool is_blank(char c)
{
    return c == ' ' || c == '\t';
}

/* Gets the next field of a line. Returns false at the end of the line. */
static bool next_word(const char **at, const char *end, word *out)
{
    while (*at < end && is_blank(**at)) {
        ++*at;
    }
    out->at = *at;
    while (*at < end && !is_blank(**at)) {
        ++*at;
    }
    out->length = (size_t)(*at - out->at);
    return out->length > 0;
}

static bool check_bytes(const reader *r, const char *at, size_t length)
{
    if (length > API_TOKEN_LINE) {
        return fail(r, "the line is longer than %d bytes", API_TOKEN_LINE);
    }
    for (size_t i = 0; i < length; i++) {
        if ((unsigned char)at[i] < ' ' && at[i] != '\t') {
            return fail(r, "byte %zu is a control character", i + 1);
        }
    }
    return true;
}

static bool read_line(const reader *r, const char *at, size_t length, api_token *out)
{
    const char *end = at + length;
    unsigned seen = 0;
    word name, role, hash, more;
    if (!next_word(&at, end, &name) || !next_word(&at, end, &role) || !next_word(&at, end, &hash)) {
        return fail(r, "the line does not have the form NAME ROLE sha256:HASH");
    }
    if (!read_name(r, name, out) || !read_role(r, role, out) || !read_hash(r, hash, out)) {
        return false;
    }
    while (next_word(&at, end, &more)) {
        if (!read_setting(r, more, &seen, out)) {
            return false;
        }
    }
    bool everything = out->role == API_ROLE_ADMIN || out->role == API_ROLE_METRICS;
    return !everything || out->prefix_count == 0 ||
           fail(r, "a token with the role %s may not have prefix=", api_role_name(out->role));
}

/* --- reading the whole file --- */

/* A hash table that finds repeated names or repeated token hashes. Its chains consist of indices of
 * tokens. */
typedef struct met {
    /* heads: first token of each chain; nexts: the token after each token; both as index + 1, 0 for
     * the end of the chain. */
    uint32_t *heads, *nexts;
    uint64_t secret[2];
} met;

enum { BUCKETS = 2 * API_TOKENS };

static bool met_new(met *m)
{
    m->heads = he_mem_zero(BUCKETS, sizeof *m->heads);
    m->nexts = he_mem_zero(API_TOKENS, sizeof *m->nexts);
    m->secret[0] = st_random();
    m->secret[1] = st_random();
    return m->heads != NULL && m->nexts != NULL;
}

static void met_free(met *m)
{
    he_mem_free(m->heads);
    he_mem_free(m->nexts);
}

/* Returns an earlier token of the list whose member at `offset`, of `size` bytes, equals that
 * member of the last token. If there is none, adds the last token to the table and returns NULL. */
static const api_token *met_find(met *m, const api_token_list *list, size_t offset, size_t size)
{
    uint32_t last = (uint32_t)list->count - 1;
    const char *member = (const char *)list->items[last] + offset;
    uint32_t *head = &m->heads[he_siphash_of(m->secret, member, size) % BUCKETS];
    for (uint32_t at = *head; at != 0; at = m->nexts[at - 1]) {
        if (memcmp((const char *)list->items[at - 1] + offset, member, size) == 0) {
            return list->items[at - 1];
        }
    }
    m->nexts[last] = *head;
    *head = last + 1;
    return NULL;
}

/* The tokens read so far, and tables of their names and hashes, each of which must be unique. */
typedef struct gathered {
    api_token_list list;
    met names, hashes;
} gathered;

static bool add_token(reader *r, const char *at, size_t length, gathered *to)
{
    api_token_list *list = &to->list;
    if (list->count == API_TOKENS) {
        return fail(r, "there are more than %d tokens", API_TOKENS);
    }
    api_token *token = he_mem_zero(1, sizeof *token);
    if (token == NULL) {
        return fail(&(reader){0, r->message}, "no memory for the tokens");
    }
    token->expires = HUGE_VAL;
    token->line = r->line;
    atomic_init(&token->uses, 1);
    atomic_init(&token->revoked, false);
    for (size_t i = 0; i < API_LIMIT_COUNT; i++) {
        atomic_init(&token->limits[i], 0);
    }
    list->items[list->count++] = token;
    if (!read_line(r, at, length, token)) {
        return false;
    }
    const api_token *other =
        met_find(&to->names, list, offsetof(api_token, name), sizeof token->name);
    if (other != NULL) {
        return fail(r, "the token in line %zu already has this name", other->line);
    }
    other = met_find(&to->hashes, list, offsetof(api_token, hash), sizeof token->hash);
    return other == NULL || fail(r, "the token in line %zu already has this hash", other->line);
}

static bool read_lines(reader *r, const char *at, const char *end, gathered *to)
{
    while (at < end) {
        const char *newline = memchr(at, '\n', (size_t)(end - at));
        const char *stop = newline == NULL ? end : newline;
        const char *first = at;
        r->line++;
        while (first < stop && is_blank(*first)) {
            first++;
        }
        if (!check_bytes(r, at, (size_t)(stop - at))) {
            return false;
        }
        if (first < stop && *first != '#' && !add_token(r, first, (size_t)(stop - first), to)) {
            return false;
        }
        at = newline == NULL ? end : newline + 1;
    }
    r->line = 0;
    return to->list.count > 0 || fail(r, "the file of tokens has no token");
}

bool api_token_file_read(const char *bytes, size_t length, api_token_list *out,
                         char message[API_TOKENS_MESSAGE])
{
    reader r = {.message = message};
    gathered all = {.list = {he_mem_zero(API_TOKENS, sizeof *all.list.items), 0}};
    bool memory = met_new(&all.names);
    memory = met_new(&all.hashes) && memory && all.list.items != NULL;
    bool good = length <= API_TOKENS_FILE ||
                fail(&r, "the file of tokens is larger than %d bytes", API_TOKENS_FILE);
    good = good && (memory || fail(&r, "no memory for the tokens")) &&
           read_lines(&r, bytes, bytes + length, &all);
    met_free(&all.names);
    met_free(&all.hashes);
    if (good) {
        *out = all.list;
    } else {
        api_token_list_clear(&all.list);
    }
    return good;
}

void api_token_list_clear(api_token_list *list)
{
    for (size_t i = 0; i < list->count; i++) {
        api_token_release(list->items[i]);
    }
    he_mem_free(list->items);
    *list = (api_token_list){NULL, 0};
}

void api_token_file_line(const char *name, api_role role, const char *token,
                         char out[API_TOKEN_SHORT_LINE])
{
    unsigned char hash[API_TOKEN_HASH];
    api_token_hash(token, strlen(token), hash);
    int used = snprintf(out, API_TOKEN_SHORT_LINE, "%s %s sha256:", name, api_role_name(role));
    for (size_t i = 0; i < API_TOKEN_HASH; i++) {
        snprintf(out + used + 2 * i, 3, "%02x", hash[i]);
    }
}
