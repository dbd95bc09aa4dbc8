#include "server/http_gate.h"

#include <time.h>

void srv_gate_init(srv_gate *gate)
{
    *gate = (srv_gate){0};
    pthread_mutex_init(&gate->lock, NULL);
    pthread_cond_init(&gate->ended, NULL);
}

void srv_gate_clear(srv_gate *gate)
{
    pthread_mutex_destroy(&gate->lock);
    pthread_cond_destroy(&gate->ended);
}

void srv_gate_enter(srv_gate *gate)
{
    pthread_mutex_lock(&gate->lock);
    gate->active++;
    pthread_mutex_unlock(&gate->lock);
}

void srv_gate_leave(srv_gate *gate)
{
    pthread_mutex_lock(&gate->lock);
    if (--gate->active == 0) {
        pthread_cond_broadcast(&gate->ended);
    }
    pthread_mutex_unlock(&gate->lock);
}

bool srv_gate_wait(srv_gate *gate)
{
    pthread_mutex_lock(&gate->lock);
    bool allowed = !gate->closed;
    gate->waiting += allowed ? 1 : 0;
    pthread_mutex_unlock(&gate->lock);
    return allowed;
}

void srv_gate_resume(srv_gate *gate)
{
    pthread_mutex_lock(&gate->lock);
    gate->waiting--;
    pthread_mutex_unlock(&gate->lock);
}

bool srv_gate_close(srv_gate *gate, unsigned millis)
{
    struct timespec until;
    clock_gettime(CLOCK_REALTIME, &until);
    until.tv_sec += millis / 1000;
    until.tv_nsec += (long)(millis % 1000) * 1000000;
    if (until.tv_nsec >= 1000000000) {
        until.tv_nsec -= 1000000000;
        until.tv_sec++;
    }
    pthread_mutex_lock(&gate->lock);
    int timed_out = 0;
    while (gate->active > 0 && timed_out == 0) {
        timed_out = pthread_cond_timedwait(&gate->ended, &gate->lock, &until);
    }
    gate->closed = gate->waiting == 0;
    bool closed = gate->closed;
    pthread_mutex_unlock(&gate->lock);
    return closed;
}
