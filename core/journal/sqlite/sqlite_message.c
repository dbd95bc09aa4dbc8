#include "journal/sqlite/sqlite_message.h"

#include <stdarg.h>
#include <stdio.h>

bool st_refuse(char message[ST_SQLITE_MESSAGE], const char *format, ...)
{
    va_list values;
    va_start(values, format);
    (void)vsnprintf(message, ST_SQLITE_MESSAGE, format, values);
    va_end(values);
    return false;
}
