/* random.h - unguessable numbers and ids, from the kernel. */
#ifndef HE_SYSTEM_RANDOM_H
#define HE_SYSTEM_RANDOM_H

#include <stddef.h>
#include <stdint.h>

uint64_t st_random(void);
/* `length` characters of A-Z a-z 0-9, each equally likely, and a final null: 10 hold 59 bits. */
void st_random_id(char *out, size_t length);

#endif
