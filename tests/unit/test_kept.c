/* A constant answer body must be compressed only once for each content coding, by the first thread
 * that needs it, and must decode to the original bytes. */
#include "api/header/kept.h"

#include "fixture.h"
#include "tests/failing.h"
#include "tests/model/random.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>
#include <zstd.h>

/* length of the longest body: more bytes than a compressor reads at once */
enum { LONGEST = 300 * 1000 };

static char body[LONGEST], decoded[LONGEST];

static void fill_body(bool random)
{
    md_random numbers = {11};
    for (size_t i = 0; i < sizeof body; i++) {
        body[i] = random ? (char)md_below(&numbers, 256) : "{\"vertex\":0}"[i * i % 12];
    }
}

static size_t decode(api_coding coding, const char *bytes, size_t length)
{
    if (coding == API_ZSTD) {
        return ZSTD_decompress(decoded, sizeof decoded, bytes, length);
    }
    z_stream z = {.next_in = (z_const Bytef *)bytes,
                  .avail_in = (unsigned)length,
                  .next_out = (Bytef *)decoded,
                  .avail_out = sizeof decoded};
    assert_int_equal(inflateInit2(&z, MAX_WBITS + 16), Z_OK);
    const int status = inflate(&z, Z_FINISH);
    inflateEnd(&z);
    return status == Z_STREAM_END ? z.total_out : SIZE_MAX;
}

static void each_form_decodes_to_the_body(void **state)
{
    (void)state;
    static const size_t lengths[] = {0, 1, 1000, 64 * 1024, 64 * 1024 + 1, LONGEST};
    for (int random = 0; random < 2; random++) {
        fill_body(random);
        for (size_t i = 0; i < sizeof lengths / sizeof *lengths; i++) {
            api_kept *kept = api_kept_new(body, lengths[i]);
            assert_non_null(kept);
            for (api_coding coding = 0; coding < API_IDENTITY; coding++) {
                const char *bytes;
                size_t length;
                assert_true(api_kept_coded(kept, coding, &bytes, &length));
                assert_int_equal(decode(coding, bytes, length), lengths[i]);
                assert_memory_equal(decoded, body, lengths[i]);
            }
            api_kept_free(kept);
        }
    }
}

static void a_form_is_made_once(void **state)
{
    (void)state;
    fill_body(false);
    api_kept *kept = api_kept_new(body, sizeof body);
    const char *first, *second, *plain;
    size_t length, same;
    assert_true(api_kept_coded(kept, API_ZSTD, &first, &length));
    assert_true(api_kept_coded(kept, API_ZSTD, &second, &same));
    assert_ptr_equal(first, second);
    assert_int_equal(length, same);
    assert_true(length < sizeof body / 10);
    api_kept_bytes(kept, &plain, &length);
    assert_int_equal(length, sizeof body);
    assert_memory_equal(plain, body, sizeof body);
    api_kept_free(kept);
}

static void equal_bodies_have_equal_tags_and_others_do_not(void **state)
{
    (void)state;
    fill_body(false);
    api_kept *a = api_kept_new(body, 1000), *b = api_kept_new(body, 1000);
    body[999] ^= 1;
    api_kept *changed = api_kept_new(body, 1000), *shorter = api_kept_new(body, 999);
    assert_string_equal(api_kept_etag(a), api_kept_etag(b));
    assert_string_not_equal(api_kept_etag(a), api_kept_etag(changed));
    assert_string_not_equal(api_kept_etag(a), api_kept_etag(shorter));
    assert_int_equal(api_kept_etag(a)[0], '"');
    api_kept *all[] = {a, b, changed, shorter};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        api_kept_free(all[i]);
    }
}

/* --- many threads --- */

typedef struct reader {
    pthread_t thread;
    api_kept *kept;
    pthread_barrier_t *start;
    const char *bytes[API_IDENTITY];
    bool ok;
} reader;

static void *read_forms(void *context)
{
    reader *r = context;
    size_t length;
    pthread_barrier_wait(r->start);
    r->ok = true;
    for (api_coding coding = 0; coding < API_IDENTITY; coding++) {
        r->ok = api_kept_coded(r->kept, coding, &r->bytes[coding], &length) && r->ok;
    }
    return NULL;
}

static void threads_that_ask_at_once_get_one_form(void **state)
{
    (void)state;
    enum { READERS = 4, ROUNDS = 20 };
    reader readers[READERS];
    pthread_barrier_t start;
    fill_body(false);
    for (int round = 0; round < ROUNDS; round++) {
        api_kept *kept = api_kept_new(body, 10000);
        pthread_barrier_init(&start, NULL, READERS);
        for (int i = 0; i < READERS; i++) {
            readers[i] = (reader){.kept = kept, .start = &start};
            assert_int_equal(pthread_create(&readers[i].thread, NULL, read_forms, &readers[i]), 0);
        }
        for (int i = 0; i < READERS; i++) {
            pthread_join(readers[i].thread, NULL);
            assert_true(readers[i].ok);
            for (api_coding coding = 0; coding < API_IDENTITY; coding++) {
                assert_ptr_equal(readers[i].bytes[coding], readers[0].bytes[coding]);
            }
        }
        pthread_barrier_destroy(&start);
        api_kept_free(kept);
    }
}

static void without_memory_the_next_call_tries_again(void **state)
{
    (void)state;
    fill_body(false);
    for (api_coding coding = 0; coding < API_IDENTITY; coding++) {
        failing f = {.may_succeed = true}; /* a form that cannot be shrunk stays as it is */
        while (failing_next(&f)) {
            api_kept *kept = api_kept_new(body, 1000);
            const char *bytes;
            size_t length;
            const bool done = kept != NULL && api_kept_coded(kept, coding, &bytes, &length);
            (void)failing_status(&f, done ? HE_OK : HE_NO_MEMORY);
            if (kept != NULL) {
                assert_true(api_kept_coded(kept, coding, &bytes, &length));
                assert_int_equal(decode(coding, bytes, length), 1000);
            }
            api_kept_free(kept);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_form_decodes_to_the_body),
        cmocka_unit_test(a_form_is_made_once),
        cmocka_unit_test(equal_bodies_have_equal_tags_and_others_do_not),
        cmocka_unit_test(threads_that_ask_at_once_get_one_form),
        cmocka_unit_test(without_memory_the_next_call_tries_again),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
