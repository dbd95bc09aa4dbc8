#include "server/http/http_lists.h"

#include "base/mem.h"

#include <string.h>
#include <strings.h>

static const char *const names[SRV_LISTS] = {"Accept",   "Accept-Encoding", "Content-Encoding",
                                             "If-Match", "If-None-Match",   "Prefer"};

static bool is_named(const srv_field *field, const char *name, size_t length)
{
    return field->name_length == length && strncasecmp(field->name, name, length) == 0;
}

static char *join(const srv_head *head, const char *name, size_t length, size_t bytes)
{
    char *joined = he_mem_alloc(bytes), *at = joined;
    for (size_t i = 0; joined != NULL && i < head->field_count; i++) {
        const srv_field *field = &head->fields[i];
        if (is_named(field, name, length)) {
            if (at != joined) {
                *at++ = ',';
            }
            memcpy(at, field->value, field->value_length);
            at += field->value_length;
        }
    }
    if (joined != NULL) {
        *at = '\0';
    }
    return joined;
}

bool srv_lists_join(srv_lists *lists, const srv_head *head)
{
    for (size_t n = 0; n < SRV_LISTS; n++) {
        size_t length = strlen(names[n]), count = 0, bytes = 0;
        for (size_t i = 0; i < head->field_count; i++) {
            if (is_named(&head->fields[i], names[n], length)) {
                count++;
                bytes += head->fields[i].value_length + 1;
            }
        }
        if (count > 1) {
            lists->joined[n] = join(head, names[n], length, bytes);
            if (lists->joined[n] == NULL) {
                return false;
            }
        }
    }
    return true;
}

void srv_lists_clear(srv_lists *lists)
{
    for (size_t n = 0; n < SRV_LISTS; n++) {
        he_mem_free(lists->joined[n]);
    }
}

const char *srv_lists_find(const srv_lists *lists, const char *name)
{
    for (size_t n = 0; n < SRV_LISTS; n++) {
        if (lists->joined[n] != NULL && strcasecmp(names[n], name) == 0) {
            return lists->joined[n];
        }
    }
    return NULL;
}
