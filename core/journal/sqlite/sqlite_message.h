/* sqlite_message.h - writes the sentences that say why something was refused. */
#ifndef HE_JOURNAL_SQLITE_MESSAGE_H
#define HE_JOURNAL_SQLITE_MESSAGE_H

#include <stdbool.h>

enum { ST_SQLITE_MESSAGE = 768 };

/* Writes a sentence, cut if it is too long. Returns false. */
__attribute__((format(printf, 2, 3))) bool st_refuse(char message[ST_SQLITE_MESSAGE],
                                                     const char *format, ...);

#endif
