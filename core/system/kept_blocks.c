#include "system/kept_blocks.h"

#include <malloc.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdlib.h>

/* Blocks are kept by their class, which is their size divided by STEP and rounded down. So a block
 * of class k has at least k * STEP bytes, and new blocks are given a multiple of STEP. */
enum { STEP = 1024, FIRST_CLASS = 2, LAST_CLASS = 8, CLASSES = LAST_CLASS - FIRST_CLASS + 1 };

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
enum { IS_KEEPING = false };
#else
enum { IS_KEEPING = true };
#endif

enum { MOST = 2 }; /* the most blocks of one class that a thread keeps */

typedef struct kept {
    void *blocks[CLASSES][MOST];
    unsigned char counts[CLASSES];
    /* true once the thread is to free its blocks when it ends */
    bool ends;
} kept;

static _Thread_local kept own;
static pthread_once_t once = PTHREAD_ONCE_INIT;
static pthread_key_t at_end;
static bool has_key;

static void free_all(void *context)
{
    kept *k = context;
    for (size_t c = 0; c < CLASSES; c++) {
        while (k->counts[c] > 0) {
            free(k->blocks[c][--k->counts[c]]);
        }
    }
    /* If another destructor of the thread frees a block later, the destructors run again. */
    k->ends = false;
}

static void make_key(void)
{
    has_key = pthread_key_create(&at_end, free_all) == 0;
}

/* Arranges that the thread's blocks are freed when the thread ends. Returns false if that is not
 * possible; then nothing may be kept. */
static bool will_end(kept *k)
{
    if (!k->ends) {
        pthread_once(&once, make_key);
        k->ends = has_key && pthread_setspecific(at_end, k) == 0;
    }
    return k->ends;
}

void *st_kept_alloc(size_t size)
{
    kept *k = &own;
    if (!IS_KEEPING || size <= (FIRST_CLASS - 1) * STEP || size > LAST_CLASS * STEP) {
        return malloc(size);
    }
    const size_t class = (size + STEP - 1) / STEP, c = class - FIRST_CLASS;
    return k->counts[c] > 0 ? k->blocks[c][--k->counts[c]] : malloc(class * STEP);
}

void st_kept_free(void *memory)
{
    kept *k = &own;
    const size_t class = memory == NULL ? 0 : malloc_usable_size(memory) / STEP;
    if (!IS_KEEPING || class < FIRST_CLASS || class > LAST_CLASS ||
        k->counts[class - FIRST_CLASS] == MOST || !will_end(k)) {
        free(memory);
        return;
    }
    const size_t c = class - FIRST_CLASS;
    k->blocks[c][k->counts[c]++] = memory;
}
