/* If many connections reach their deadlines at once, they must be closed a few at a time, so that
 * other threads can take the lock in between. The test counts how many connections are closed while
 * the lock is held once. */
#include "server/http/http_deadline.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>
#include <pthread.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cmocka.h>

enum { LATE = 500 };

static _Thread_local int
    closed_since; /* number of connections closed since this thread took the lock */
static _Atomic int most, closed;

int __real_pthread_mutex_lock(pthread_mutex_t *mutex);
int __wrap_pthread_mutex_lock(pthread_mutex_t *mutex);
int __wrap_pthread_mutex_lock(pthread_mutex_t *mutex)
{
    closed_since = 0;
    return __real_pthread_mutex_lock(mutex);
}

int __real_shutdown(int socket, int how);
int __wrap_shutdown(int socket, int how);
int __wrap_shutdown(int socket, int how)
{
    closed_since++;
    most = closed_since > most ? closed_since : most;
    closed++;
    return __real_shutdown(socket, how);
}

/* Pairs of connected sockets: `others` are the clients' ends, `watched` are the records of the
 * server's ends. */
typedef struct pairs {
    int others[LATE];
    srv_connection *watched[LATE];
} pairs;

static void open_pairs(srv_deadlines *d, pairs *p)
{
    struct sockaddr peer = {.sa_family = AF_UNSPEC};
    for (int i = 0; i < LATE; i++) {
        int ends[2];
        assert_int_equal(socketpair(AF_UNIX, SOCK_STREAM, 0, ends), 0);
        p->others[i] = ends[1];
        p->watched[i] = srv_deadlines_add(d, ends[0], &peer, NULL, UINT32_MAX);
        assert_non_null(p->watched[i]);
    }
}

static void close_pairs(srv_deadlines *d, pairs *p)
{
    for (int i = 0; i < LATE; i++) {
        int own = p->watched[i]->socket;
        srv_deadlines_remove(d, p->watched[i]);
        close(own);
        close(p->others[i]);
    }
}

static void those_who_are_late_together_are_closed_a_few_at_a_time(void **state)
{
    (void)state;
    pairs p;
    /* connections may be idle for 0 seconds, so all are late at once */
    const srv_deadline_options options = {.max_connections = LATE};
    srv_deadlines *d = srv_deadlines_new(&options);
    assert_non_null(d);
    open_pairs(d, &p);
    char byte;
    for (int i = 0; i < LATE; i++) { /* waits until the server has closed each connection */
        assert_int_equal(recv(p.others[i], &byte, 1, 0), 0);
    }
    assert_true(closed >= LATE);
    assert_int_equal(most, SRV_CLOSES);
    close_pairs(d, &p);
    srv_deadlines_free(d);
}

/* While the search for late connections pauses between two steps, some of the connections are
 * closed elsewhere: the search must continue with the next connection that is left. */
static void some_who_leave_during_a_sweep_do_not_end_it(void **state)
{
    (void)state;
    pairs p;
    const srv_deadline_options options = {.max_connections = LATE};
    srv_deadlines *d = srv_deadlines_new(&options);
    assert_non_null(d);
    closed = 0;
    open_pairs(d, &p);
    while (closed == 0) {
        /* Waits until one connection is closed. The search for late connections begins with the
         * connection that was added last. */
    }
    char byte;
    for (int i = LATE - 1; i >= 0; i--) {
        int own = p.watched[i]->socket;
        if (i % 3 > 0) {
            srv_deadlines_remove(d, p.watched[i]);
            close(own);
            p.watched[i] = NULL;
        }
    }
    for (int i = 0; i < LATE; i++) {
        if (p.watched[i] != NULL) {
            assert_int_equal(recv(p.others[i], &byte, 1, 0), 0);
            int own = p.watched[i]->socket;
            srv_deadlines_remove(d, p.watched[i]);
            close(own);
        }
        close(p.others[i]);
    }
    srv_deadlines_free(d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(those_who_are_late_together_are_closed_a_few_at_a_time),
        cmocka_unit_test(some_who_leave_during_a_sweep_do_not_end_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
