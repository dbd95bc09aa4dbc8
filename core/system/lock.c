#include "system/lock.h"

#include "system/clock.h"

static _Thread_local uint64_t waited;

void st_lock_count(uint64_t since)
{
    waited += st_clock_micros() - since;
}

void st_lock_read(pthread_rwlock_t *lock)
{
    if (pthread_rwlock_tryrdlock(lock) != 0) {
        const uint64_t since = st_clock_micros();
        pthread_rwlock_rdlock(lock);
        st_lock_count(since);
    }
}

void st_lock_write(pthread_rwlock_t *lock)
{
    if (pthread_rwlock_trywrlock(lock) != 0) {
        const uint64_t since = st_clock_micros();
        pthread_rwlock_wrlock(lock);
        st_lock_count(since);
    }
}

void st_lock_mutex(pthread_mutex_t *lock)
{
    if (pthread_mutex_trylock(lock) != 0) {
        const uint64_t since = st_clock_micros();
        pthread_mutex_lock(lock);
        st_lock_count(since);
    }
}

uint64_t st_lock_waited(void)
{
    return waited;
}
