#define _GNU_SOURCE /* RTLD_NEXT */

#include "server/http/http_buffer.h"

#include "base/mem.h"
#include "system/clock.h"
#include "system/memory.h"

#include <dlfcn.h>
#include <pthread.h>
#include <stdatomic.h>
#include <string.h>
#include <sys/epoll.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

enum {
    /* Microseconds without a request after which the pages of a buffer may be returned. */
    REST_MICROS = 1000 * 1000,
    /* Milliseconds between checks for buffers whose pages can be returned. */
    LOOK_MILLIS = 500,
    AT_ONCE = 32, /* the most buffers whose pages are returned in one check */
    KEPT = 64,    /* number of free buffers that keep their pages for the next connections */
    LANES = 64    /* the largest number of worker threads that --workers allows */
};

/* The states of a buffer. FREE: it belongs to no connection. USED: its connection has a request.
 * IDLE: its connection has no request, and the buffer is in the list of its worker thread. GIVEN:
 * its connection has no request, and its pages were returned to the system. */
typedef enum state { FREE, USED, IDLE, GIVEN } state;

struct lane;

typedef struct buffer {
    state state;
    uint32_t next, previous; /* neighbours in a list of free buffers or in the worker's list */
    struct lane *lane; /* the list of idle buffers of the worker thread that took the buffer */
    uint64_t since;    /* when the buffer became IDLE */
    size_t held;       /* bytes that st_memory_count counts for the buffer */
} buffer;

/* The list of a worker's IDLE buffers, in the order in which they became IDLE. It needs no lock,
 * because only the worker thread uses it; after the worker has ended, the thread that stops the
 * server closes the connections that are left. */
typedef struct lane {
    uint32_t first, last;
} lane;

static struct {
    char *memory; /* the reserved range of addresses; NULL before srv_buffers_reserve was called */
    size_t bytes; /* size of one buffer */
    size_t page;
    uint32_t most;
    buffer *buffers;
    lane lanes[LANES];
    pthread_mutex_t lock; /* protects the members below */
    size_t lanes_used;
    /* `warm` is the list of FREE buffers that still have pages, `cold` the list of FREE buffers
     * without pages, and `fresh` the index of the first buffer that was never used. */
    uint32_t warm, cold, fresh;
    uint64_t put; /* time at which a buffer was last added to the list `warm` */
    _Atomic size_t warm_count;
} all = {.lock = PTHREAD_MUTEX_INITIALIZER, .warm = SRV_NO_BUFFER, .cold = SRV_NO_BUFFER};

static _Thread_local lane *own;
static _Thread_local uint32_t taken = SRV_NO_BUFFER;

bool srv_buffers_reserve(size_t most)
{
    long page = sysconf(_SC_PAGESIZE);
    if (all.memory != NULL) {
        return true;
    }
    if (page <= 0 || most >= SRV_NO_BUFFER) {
        return false;
    }
    all.page = (size_t)page;
    all.bytes = (SRV_BUFFER_BYTES + all.page - 1) / all.page * all.page;
    all.most = (uint32_t)most;
    all.buffers = he_mem_zero(most, sizeof *all.buffers);
    void *memory = all.buffers == NULL ? MAP_FAILED
                                       : mmap(NULL, most * all.bytes, PROT_READ | PROT_WRITE,
                                              MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (memory == MAP_FAILED) {
        he_mem_free(all.buffers);
        return false;
    }
    /* Transparent huge pages are switched off, because a write to one page would allocate many
     * pages beside it. */
    madvise(memory, most * all.bytes, MADV_NOHUGEPAGE);
    all.memory = memory;
    return true;
}

static void count(buffer *b, size_t held)
{
    st_memory_count((int64_t)held - (int64_t)b->held);
    b->held = held;
}

/* --- a worker's list of idle buffers --- */

static void leave_line(uint32_t i)
{
    buffer *b = &all.buffers[i];
    uint32_t *before =
        b->previous == SRV_NO_BUFFER ? &b->lane->first : &all.buffers[b->previous].next;
    uint32_t *after = b->next == SRV_NO_BUFFER ? &b->lane->last : &all.buffers[b->next].previous;
    *before = b->next;
    *after = b->previous;
}

void srv_buffer_rest(uint32_t i, uint64_t now)
{
    if (i == SRV_NO_BUFFER || all.buffers[i].state != USED) {
        return;
    }
    buffer *b = &all.buffers[i];
    b->state = IDLE;
    b->since = now;
    b->next = SRV_NO_BUFFER;
    b->previous = b->lane->last;
    *(b->previous == SRV_NO_BUFFER ? &b->lane->first : &all.buffers[b->previous].next) = i;
    b->lane->last = i;
}

void srv_buffer_use(uint32_t i)
{
    if (i == SRV_NO_BUFFER) {
        return;
    }
    if (all.buffers[i].state == IDLE) {
        leave_line(i);
    }
    all.buffers[i].state = USED;
    count(&all.buffers[i], all.bytes);
}

/* --- returning pages to the system --- */

static bool is_zero(const char *page, size_t size)
{
    return page[0] == 0 && memcmp(page, page + 1, size - 1) == 0;
}

static void give_back(uint32_t i)
{
    buffer *b = &all.buffers[i];
    char *memory = all.memory + (size_t)i * all.bytes;
    size_t held = 0;
    for (size_t at = 0; at < all.bytes;) {
        size_t end = at;
        while (end < all.bytes && is_zero(memory + end, all.page)) {
            end += all.page;
        }
        if (end > at && madvise(memory + at, end - at, MADV_DONTNEED) != 0) {
            held += end - at;
        }
        held += end < all.bytes ? all.page : 0;
        at = end + all.page;
    }
    count(b, held);
}

static int sooner(int timeout)
{
    return timeout < 0 || timeout > LOOK_MILLIS ? LOOK_MILLIS : timeout;
}

/* --- lists of free buffers; the caller holds the lock --- */

static void push(uint32_t *list, uint32_t i)
{
    all.buffers[i].next = *list;
    *list = i;
}

static uint32_t pop(uint32_t *list)
{
    uint32_t i = *list;
    *list = all.buffers[i].next;
    return i;
}

/* Gives the pages of FREE buffers back to the system, except KEPT buffers, when no connection has
 * ended for a second. Returns how many milliseconds the worker thread may wait before the next
 * check; `timeout` is how long it would wait otherwise. */
static int give_back_free(int timeout)
{
    if (atomic_load_explicit(&all.warm_count, memory_order_relaxed) <= KEPT) {
        return timeout;
    }
    uint64_t now = st_clock_micros();
    bool more = false;
    pthread_mutex_lock(&all.lock);
    bool ripe = now - all.put >= REST_MICROS || st_memory_is_full();
    for (int done = 0; ripe && done < AT_ONCE; done++) {
        if (atomic_load_explicit(&all.warm_count, memory_order_relaxed) <= KEPT) {
            break;
        }
        uint32_t i = pop(&all.warm);
        atomic_fetch_sub_explicit(&all.warm_count, 1, memory_order_relaxed);
        madvise(all.memory + (size_t)i * all.bytes, all.bytes, MADV_DONTNEED);
        count(&all.buffers[i], 0);
        push(&all.cold, i);
        more = done + 1 == AT_ONCE;
    }
    pthread_mutex_unlock(&all.lock);
    return more ? 0 : sooner(timeout);
}

/* Gives the pages of this worker's buffers that have been IDLE long enough back to the system.
 * Returns how many milliseconds the worker thread may wait before the next check; `timeout` is how
 * long it would wait otherwise. */
static int give_back_idle(int timeout)
{
    if (own == NULL || own->first == SRV_NO_BUFFER) {
        return timeout;
    }
    uint64_t now = st_clock_micros();
    uint64_t rest = st_memory_is_full() ? 0 : REST_MICROS;
    for (int done = 0; done < AT_ONCE && own->first != SRV_NO_BUFFER; done++) {
        uint32_t i = own->first;
        if (now - all.buffers[i].since < rest) {
            return sooner(timeout);
        }
        leave_line(i);
        all.buffers[i].state = GIVEN;
        give_back(i);
    }
    return own->first == SRV_NO_BUFFER ? timeout : 0;
}

/* --- the functions that libmicrohttpd calls --- */

uint32_t srv_buffer_taken(void)
{
    uint32_t last = taken;
    taken = SRV_NO_BUFFER;
    return last;
}

static void *take(void)
{
    pthread_mutex_lock(&all.lock);
    if (own == NULL && all.lanes_used < LANES) {
        own = &all.lanes[all.lanes_used++];
        *own = (lane){SRV_NO_BUFFER, SRV_NO_BUFFER};
    }
    uint32_t i = SRV_NO_BUFFER;
    if (own == NULL) {
        /* All lists belong to other threads, because servers were started and stopped many times in
         * this process. So the memory comes from the system. */
    } else if (all.warm != SRV_NO_BUFFER) {
        i = pop(&all.warm);
        atomic_fetch_sub_explicit(&all.warm_count, 1, memory_order_relaxed);
    } else if (all.cold != SRV_NO_BUFFER) {
        i = pop(&all.cold);
    } else if (all.fresh < all.most) {
        i = all.fresh++;
    }
    pthread_mutex_unlock(&all.lock);
    if (i == SRV_NO_BUFFER) {
        return NULL;
    }
    all.buffers[i].state = USED;
    all.buffers[i].lane = own;
    count(&all.buffers[i], all.bytes);
    taken = i;
    return all.memory + (size_t)i * all.bytes;
}

static void put(uint32_t i)
{
    buffer *b = &all.buffers[i];
    if (b->state == IDLE) {
        leave_line(i);
    }
    b->state = FREE;
    uint64_t now = st_clock_micros();
    pthread_mutex_lock(&all.lock);
    if (b->held > 0) {
        push(&all.warm, i);
        atomic_fetch_add_explicit(&all.warm_count, 1, memory_order_relaxed);
        all.put = now;
    } else {
        push(&all.cold, i);
    }
    pthread_mutex_unlock(&all.lock);
}

typedef void *(*map_function)(void *, size_t, int, int, int, off_t);
typedef int (*unmap_function)(void *, size_t);

/* Marks functions that the dynamic linker may call before main, when a sanitizer is not initialised
 * yet, so that they must not be instrumented. */
#define UNWATCHED __attribute__((no_sanitize("thread"), no_sanitize("address")))

/* Returns the function that a function with this name in this program hides: the function of the C
 * library or, if there is one, of a sanitizer. *kept remembers the result. */
static void *next_definition(_Atomic(void *) *kept, const char *name)
{
    void *found = atomic_load_explicit(kept, memory_order_acquire);
    if (found == NULL) {
        found = dlsym(RTLD_NEXT, name);
        atomic_store_explicit(kept, found, memory_order_release);
    }
    return found;
}

static void *map(void *address, size_t length, int protection, int flags, int fd, off_t offset)
{
    static _Atomic(void *) next;
    map_function system = NULL;
    if (address == NULL && length == all.bytes && flags == (MAP_PRIVATE | MAP_ANONYMOUS)) {
        void *memory = take();
        if (memory != NULL) {
            return memory;
        }
    }
    *(void **)&system = next_definition(&next, "mmap");
    return system(address, length, protection, flags, fd, offset);
}

static int unmap(void *address, size_t length)
{
    static _Atomic(void *) next;
    unmap_function system = NULL;
    size_t at = (size_t)((char *)address - all.memory);
    if ((char *)address >= all.memory && at < (size_t)all.most * all.bytes) {
        put((uint32_t)(at / all.bytes));
        return 0;
    }
    *(void **)&system = next_definition(&next, "munmap");
    return system(address, length);
}

UNWATCHED void *mmap(void *address, size_t length, int protection, int flags, int fd, off_t offset)
{
    if (all.memory == NULL) {
        long mapped = syscall(SYS_mmap, address, length, protection, flags, fd, offset);
        return (void *)mapped; /* an address, or MAP_FAILED */
    }
    return map(address, length, protection, flags, fd, offset);
}

UNWATCHED int munmap(void *address, size_t length)
{
    return all.memory == NULL ? (int)syscall(SYS_munmap, address, length) : unmap(address, length);
}

/* Replaces the epoll_wait() of the C library, so that worker threads give pages back before they
 * wait. epoll_pwait() without a signal mask does what the replaced function did. */
int epoll_wait(int set, struct epoll_event *events, int most, int timeout)
{
    return epoll_pwait(set, events, most, give_back_idle(give_back_free(timeout)), NULL);
}
