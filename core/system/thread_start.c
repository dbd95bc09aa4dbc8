#define _GNU_SOURCE /* for gettid */
#include "system/thread_start.h"

#include <errno.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

void st_thread_name(const char *name)
{
    prctl(PR_SET_NAME, name);
}

void st_thread_name_nicer(const char *name)
{
    st_thread_name(name);
    /* On Linux each thread has a niceness of its own. A thread may always become nicer; if it does
     * not, it only competes as before. */
    const id_t self = (id_t)gettid();
    errno = 0;
    int now = getpriority(PRIO_PROCESS, self);
    if (now != -1 || errno == 0) {
        (void)setpriority(PRIO_PROCESS, self, now + ST_NICER);
    }
}
