/* version.h - the version of hedged. The tag of a release is "v" followed by SRV_VERSION; `make
 * lint` compares the two. */
#ifndef HE_SERVER_VERSION_H
#define HE_SERVER_VERSION_H

#define SRV_VERSION "0.1.0"

/* The git commit from which hedged was built; "+" follows it if files had been changed since that
 * commit. It is "" if the sources are not in a git repository and make was not given COMMIT=. */
extern const char srv_commit[];

#endif
