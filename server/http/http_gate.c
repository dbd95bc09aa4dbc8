#include "server/http/http_gate.h"

#include "system/clock.h"

void srv_gate_init(srv_gate *gate)
{
    *gate = (srv_gate){0};
    pthread_mutex_init(&gate->lock, NULL);
    st_clock_condition(&gate->ended);
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
    const uint64_t until = st_clock_micros() + (uint64_t)millis * 1000;
    bool in_time = true;
    pthread_mutex_lock(&gate->lock);
    while (gate->active > 0 && in_time) {
        in_time = st_clock_wait(&gate->ended, &gate->lock, until);
    }
    gate->closed = gate->waiting == 0;
    bool closed = gate->closed;
    pthread_mutex_unlock(&gate->lock);
    return closed;
}
