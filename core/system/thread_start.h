/* thread_start.h - what a thread of the daemon does first. */
#ifndef HE_SYSTEM_THREAD_START_H
#define HE_SYSTEM_THREAD_START_H

/* By how much threads of long work are nicer (nice(2)) than those that serve connections. The
 * system gives them about a third of a processor for which both compete, and a thread that becomes
 * ready to serve a connection need not wait until they have used up their slice of time. */
enum { ST_NICER = 5 };

/* Gives the calling thread a name of at most 15 characters, which the tools of the system show. */
void st_thread_name(const char *name);
/* Names the calling thread as st_thread_name does, and makes it nicer by ST_NICER. For threads that
 * may compute for long. */
void st_thread_name_nicer(const char *name);

#endif
