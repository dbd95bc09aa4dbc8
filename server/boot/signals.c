#include "server/boot/signals.h"

#include <stddef.h>

/* Ignores signals that would end the process although they have no meaning for it: those about
 * closed connections, timers and descriptors, and those that other daemons use as commands. */
static void ignore_signals(void)
{
    static const int harmless[] = {SIGPIPE, SIGALRM, SIGUSR1,   SIGUSR2, SIGVTALRM,
                                   SIGPROF, SIGPOLL, SIGSTKFLT, SIGPWR};
    for (size_t i = 0; i < sizeof harmless / sizeof *harmless; i++) {
        signal(harmless[i], SIG_IGN);
    }
    for (int number = SIGRTMIN; number <= SIGRTMAX; number++) {
        signal(number, SIG_IGN);
    }
}

void srv_signals_begin(sigset_t *waited)
{
    ignore_signals();
    sigemptyset(waited);
    sigaddset(waited, SIGTERM);
    sigaddset(waited, SIGINT);
    sigaddset(waited, SIGHUP);
    pthread_sigmask(SIG_BLOCK, waited, NULL);
}
