#include "server/http/http_inflight.h"

#include "system/clock.h"

void srv_inflight_init(srv_inflight *inflight)
{
    *inflight = (srv_inflight){0};
    pthread_mutex_init(&inflight->lock, NULL);
    st_clock_condition(&inflight->ended);
}

void srv_inflight_clear(srv_inflight *inflight)
{
    pthread_mutex_destroy(&inflight->lock);
    pthread_cond_destroy(&inflight->ended);
}

void srv_inflight_enter(srv_inflight *inflight)
{
    pthread_mutex_lock(&inflight->lock);
    inflight->active++;
    pthread_mutex_unlock(&inflight->lock);
}

void srv_inflight_leave(srv_inflight *inflight)
{
    pthread_mutex_lock(&inflight->lock);
    if (--inflight->active == 0) {
        pthread_cond_broadcast(&inflight->ended);
    }
    pthread_mutex_unlock(&inflight->lock);
}

bool srv_inflight_wait(srv_inflight *inflight)
{
    pthread_mutex_lock(&inflight->lock);
    bool allowed = !inflight->closed;
    inflight->waiting += allowed ? 1 : 0;
    pthread_mutex_unlock(&inflight->lock);
    return allowed;
}

void srv_inflight_resume(srv_inflight *inflight)
{
    pthread_mutex_lock(&inflight->lock);
    inflight->waiting--;
    pthread_mutex_unlock(&inflight->lock);
}

bool srv_inflight_close(srv_inflight *inflight, unsigned millis)
{
    const uint64_t until = st_clock_micros() + (uint64_t)millis * 1000;
    bool in_time = true;
    pthread_mutex_lock(&inflight->lock);
    while (inflight->active > 0 && in_time) {
        in_time = st_clock_wait(&inflight->ended, &inflight->lock, until);
    }
    inflight->closed = inflight->waiting == 0;
    bool closed = inflight->closed;
    pthread_mutex_unlock(&inflight->lock);
    return closed;
}
