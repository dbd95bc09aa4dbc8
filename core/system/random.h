/* random.h - unguessable numbers and ids, from the kernel. */
#ifndef HE_SYSTEM_RANDOM_H
#define HE_SYSTEM_RANDOM_H

#include <stddef.h>
#include <stdint.h>

uint64_t st_random(void);
/* Writes `length` characters of A-Z a-z 0-9, each equally likely, and a NUL: 10 characters hold 59
 * random bits. */
void st_random_id(char *out, size_t length);

#endif
