#include "format/io/beside.h"

#include "format/text/warnings.h"

#include <stdio.h>
#include <string.h>

static size_t base_of(const char *name, size_t length)
{
    size_t at = length;
    while (at > 0 && name[at - 1] != '/' && name[at - 1] != '\\') {
        at--;
    }
    return at;
}

static bool is_name(const char *whole, const char *name, size_t length)
{
    return strlen(whole) == length && memcmp(whole, name, length) == 0;
}

static he_beside_file *find_exact(he_beside *beside, const char *name, size_t length)
{
    for (size_t i = 0; i < beside->count; i++) {
        if (is_name(beside->files[i].name, name, length)) {
            return &beside->files[i];
        }
    }
    return NULL;
}

/* Finds a file by the last part of its name. Returns NULL if no file, or several files in different
 * folders, have this name. */
static he_beside_file *find_base(he_beside *beside, const char *name, size_t length)
{
    size_t base = base_of(name, length);
    he_beside_file *found = NULL;
    for (size_t i = 0; i < beside->count && base < length; i++) {
        const char *other = beside->files[i].name;
        if (is_name(other + base_of(other, strlen(other)), name + base, length - base)) {
            if (found != NULL) {
                return NULL;
            }
            found = &beside->files[i];
        }
    }
    return found;
}

static const he_beside_file *use(he_beside_file *file)
{
    if (file != NULL) {
        file->used = true;
    }
    return file;
}

const he_beside_file *he_beside_find(he_beside *beside, const char *name, size_t length)
{
    if (beside == NULL) {
        return NULL;
    }
    he_beside_file *found = find_exact(beside, name, length);
    return use(found != NULL ? found : find_base(beside, name, length));
}

static int digit(char c)
{
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
}

/* Decodes the percent escapes of a URI; all else stays as it is. Returns false if the name is too
 * long. */
static bool unescape(const char *uri, size_t length, char name[HE_BESIDE_NAME], size_t *used)
{
    *used = 0;
    for (size_t i = 0; i < length; i++) {
        char c = uri[i];
        int high = c == '%' && length - i > 2 ? digit(uri[i + 1]) : -1;
        int low = high >= 0 ? digit(uri[i + 2]) : -1;
        if (low >= 0) {
            c = (char)(unsigned char)(high * 16 + low);
            i += 2;
        }
        if (*used == HE_BESIDE_NAME) {
            return false;
        }
        name[(*used)++] = c;
    }
    return true;
}

const he_beside_file *he_beside_find_uri(he_beside *beside, const char *uri, size_t length)
{
    char name[HE_BESIDE_NAME];
    size_t plain;
    if (beside == NULL || !unescape(uri, length, name, &plain)) {
        return NULL;
    }
    he_beside_file *found = find_exact(beside, uri, length);
    return found != NULL ? use(found) : he_beside_find(beside, name, plain);
}

size_t he_beside_bytes(const he_beside *beside)
{
    size_t bytes = 0;
    for (size_t i = 0; beside != NULL && i < beside->count; i++) {
        bytes += beside->files[i].length;
    }
    return bytes;
}

void he_beside_list(const he_beside *beside, char *text, size_t size)
{
    static const char more[] = ", ...";
    size_t used = 0;
    text[0] = '\0';
    for (size_t i = 0; i < beside->count; i++) {
        const char *name = beside->files[i].name;
        char quoted[HE_WARNING_SUBJECT], item[HE_WARNING_SUBJECT + 4];
        he_quote(name, name + strlen(name), quoted, sizeof quoted);
        snprintf(item, sizeof item, "%s%s", i > 0 ? ", " : "", quoted);
        if (used + strlen(item) + sizeof more > size) {
            snprintf(text + used, size - used, "%s", more + (i == 0 ? 2 : 0));
            return;
        }
        memcpy(text + used, item, strlen(item) + 1);
        used += strlen(item);
    }
}
