/* version.h - which hedged this is. A release is a tag, v and SRV_VERSION; `make lint` compares. */
#ifndef HE_SERVER_VERSION_H
#define HE_SERVER_VERSION_H

#define SRV_VERSION "0.1.0"

/* The commit it was built from, "" where the sources came without git and COMMIT= was not given to
 * make; ends with "+" when files were changed since. */
extern const char srv_commit[];

#endif
