#include "tests/failing.h"

#include "base/mem.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

/* Threads of the code under test allocate, too, so the variables that they use are atomic. */
static atomic_long calls, fail_at, blocks;
static atomic_int pauses, threads;
static atomic_bool lasts;
static bool is_installed;
static _Thread_local bool is_this_thread;

static bool is_counted(void)
{
    const int whose = atomic_load(&threads);
    return atomic_load(&pauses) == 0 &&
           (whose == FAILING_ALL_THREADS || (whose == FAILING_THIS_THREAD) == is_this_thread);
}

static void *resize(void *context, void *block, size_t size)
{
    (void)context;
    if (size == 0) {
        atomic_fetch_sub(&blocks, block != NULL);
        free(block);
        return NULL;
    }
    if (is_counted()) {
        long n = atomic_fetch_add(&calls, 1) + 1, chosen = atomic_load(&fail_at);
        if (n == chosen || (n > chosen && atomic_load(&lasts))) {
            return NULL;
        }
    }
    void *resized = realloc(block, size);
    atomic_fetch_add(&blocks, block == NULL && resized != NULL);
    return resized;
}

void failing_at(long n)
{
    static const he_mem_hook hook = {resize, NULL};
    atomic_store(&calls, 0);
    atomic_store(&pauses, 0);
    atomic_store(&lasts, false);
    atomic_store(&threads, FAILING_ALL_THREADS);
    atomic_store(&fail_at, n);
    if (!is_installed) {
        atomic_store(&blocks, 0);
        he_mem_set_hook(&hook);
        is_installed = true;
    }
}

long failing_count(void)
{
    return atomic_load(&calls);
}

long failing_blocks(void)
{
    return atomic_load(&blocks);
}

void failing_off(void)
{
    he_mem_set_hook(NULL);
    is_installed = false;
}

void failing_pause(void)
{
    atomic_fetch_add(&pauses, 1);
}

void failing_resume(void)
{
    atomic_fetch_sub(&pauses, 1);
}

bool failing_next(failing *f)
{
    if (f->is_over) {
        return false;
    }
    f->n += f->sparse > 0 ? 1 + f->n / f->sparse : 1;
    is_this_thread = true;
    failing_at(f->n);
    atomic_store(&lasts, f->lasts);
    atomic_store(&threads, (int)f->threads);
    return true;
}

bool failing_end(failing *f, bool succeeded)
{
    failing_off();
    f->is_over = failing_count() < f->n;
    if (succeeded != f->is_over && !(succeeded && f->may_succeed)) {
        fail_msg("%s: allocation %ld %s, and the run %s", f->what == NULL ? "run" : f->what, f->n,
                 f->is_over ? "was not made" : "failed", succeeded ? "succeeded" : "was refused");
    }
    return succeeded;
}

bool failing_status(failing *f, he_status status)
{
    failing_off();
    if (status != HE_OK && status != HE_NO_MEMORY) {
        fail_msg("%s: allocation %ld failed, and the status is %d",
                 f->what == NULL ? "run" : f->what, f->n, (int)status);
    }
    return failing_end(f, status == HE_OK);
}
