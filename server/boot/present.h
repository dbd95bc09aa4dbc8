/* present.h - the thread that tells listeners of meshes which other clients are there. It sleeps
 * while no client shows itself. */
#ifndef HE_SERVER_BOOT_PRESENT_H
#define HE_SERVER_BOOT_PRESENT_H

#include "server/boot/parts.h"

/* Starts the thread. Returns false, with the reason in the log, if there is none. */
bool srv_present_open(srv_parts *parts);
/* Ends the thread, if it was started. */
void srv_present_close(srv_parts *parts);

#endif
