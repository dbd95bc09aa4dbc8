#include "tests/failing.h"

#include "base/mem.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

/* Threads of the code under test may allocate too, hence the atomics. */
static struct {
    atomic_long calls;
    atomic_bool paused;
    long fail_at; /* 0 never fails */
    bool sticky;
} memory;

static void *resize(void *context, void *block, size_t size)
{
    (void)context;
    if (size == 0) {
        free(block);
        return NULL;
    }
    if (atomic_load(&memory.paused)) {
        return realloc(block, size);
    }
    long n = atomic_fetch_add(&memory.calls, 1) + 1;
    bool fails = n == memory.fail_at || (memory.sticky && n > memory.fail_at);
    return fails ? NULL : realloc(block, size);
}

static void install(long n, bool sticky)
{
    static const he_mem_hook hook = {resize, NULL};
    atomic_store(&memory.calls, 0);
    atomic_store(&memory.paused, false);
    memory.fail_at = n;
    memory.sticky = sticky;
    he_mem_set_hook(&hook);
}

void failing_begin(long n)
{
    install(n, false);
}

long failing_end(void)
{
    he_mem_set_hook(NULL);
    return atomic_load(&memory.calls);
}

void failing_pause(void)
{
    atomic_store(&memory.paused, true);
}

void failing_resume(void)
{
    atomic_store(&memory.paused, false);
}

long fails_as(const failing *f)
{
    const char *what = f->what == NULL ? "" : f->what;
    for (long n = 1;; n++) {
        install(n, f->sticky);
        int status = f->run(f->context);
        bool reached = failing_end() >= n;
        bool succeeded = status == f->done;
        bool allowed = succeeded ? !reached || f->may_succeed : reached && status == f->refused;
        if (!allowed) {
            fail_msg("%s allocation %ld %s, and the status is %d", what, n,
                     reached ? "failed" : "was not made", status);
        }
        if (!succeeded && f->compare != NULL && !f->compare(f->context)) {
            fail_msg("%s allocation %ld failed, and something has changed", what, n);
        }
        if (!reached) {
            return n;
        }
    }
}

long fails_cleanly(int (*run)(void *context), bool (*compare)(void *context), void *context)
{
    return fails_as(&(failing){.run = run,
                               .compare = compare,
                               .context = context,
                               .done = HE_OK,
                               .refused = HE_NO_MEMORY});
}
