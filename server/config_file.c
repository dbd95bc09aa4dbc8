#include "server/config_file.h"

#include "base/mem.h"
#include "server/config_option.h"

#include <ctype.h>
#include <errno.h>
#include <string.h>

enum { MOST = 64 * 1024, SOURCE_TEXT = 512 };

/* Returns the contents of a file with a NUL after them; *length does not count the NUL. Returns
 * NULL, with a sentence in `message`, if the file cannot be read or is longer than MOST bytes. */
static char *load(const char *path, size_t *length, char *message, size_t size)
{
    FILE *in = fopen(path, "rbe");
    char *text = he_mem_alloc(MOST + 1);
    if (in == NULL || text == NULL) {
        snprintf(message, size, "%s cannot be read: %s", path, strerror(errno));
        he_mem_free(text);
        text = NULL;
    } else {
        *length = fread(text, 1, MOST + 1, in);
        if (ferror(in) != 0) {
            snprintf(message, size, "%s cannot be read: %s", path, strerror(errno));
        } else if (*length > MOST) {
            snprintf(message, size,
                     "%s is longer than the %d bytes that a file of settings may have", path, MOST);
        } else {
            text[*length] = '\0';
            fclose(in);
            return text;
        }
        he_mem_free(text);
        text = NULL;
    }
    if (in != NULL) {
        fclose(in);
    }
    return text;
}

static char *trim(char *text)
{
    while (isspace((unsigned char)*text) != 0) {
        text++;
    }
    size_t length = strlen(text);
    while (length > 0 && isspace((unsigned char)text[length - 1]) != 0) {
        length--;
    }
    text[length] = '\0';
    return text;
}

/* A line of the configuration file; parsing the line overwrites its text. */
typedef struct line {
    const char *path;
    size_t number; /* from 1 */
    char *text;
} line;

static bool read_line(srv_config *config, const line *at, bool *seen, char *message, size_t size)
{
    char source[SOURCE_TEXT];
    char *text = trim(at->text);
    if (*text == '\0' || *text == '#') {
        return true;
    }
    char *equals = strchr(text, '=');
    if (equals != NULL) {
        *equals = '\0';
    }
    const char *name = trim(text), *value = equals == NULL ? NULL : trim(equals + 1);
    const srv_option *row = srv_option_find(name, strlen(name));
    if (row == NULL || !srv_option_is_setting(row)) {
        snprintf(
            message, size,
            row == NULL
                ? "%s:%zu: there is no setting \"%.40s\"; hedged --print-config lists the settings"
                : "%s:%zu: a configuration file cannot set \"%.40s\"; hedged --print-config lists "
                  "the settings",
            at->path, at->number, name);
        return false;
    }
    snprintf(source, sizeof source, "%s:%zu: %s", at->path, at->number, row->name);
    if (value == NULL && !srv_option_is_switch(row)) {
        snprintf(message, size, "%s needs a value, as in \"%s = %s\"", source, row->name,
                 row->argument);
        return false;
    }
    const srv_option_value given = {row, value == NULL ? "1" : value, source};
    return srv_option_set(config, &given, seen, message, size);
}

bool srv_config_read_file(srv_config *config, const char *path, char *message, size_t size)
{
    bool seen[SRV_MOST_OPTIONS] = {false};
    size_t length = 0;
    config->file_text = load(path, &length, message, size);
    if (config->file_text == NULL) {
        return false;
    }
    char *end = config->file_text + length;
    line at = {.path = path, .number = 1, .text = config->file_text};
    for (; at.text < end; at.number++) {
        char *stop = memchr(at.text, '\n', (size_t)(end - at.text));
        stop = stop == NULL ? end : stop;
        *stop = '\0';
        if (strlen(at.text) != (size_t)(stop - at.text)) {
            snprintf(message, size,
                     "%s:%zu: the line has a zero byte, which a text file cannot have", path,
                     at.number);
            return false;
        }
        if (!read_line(config, &at, seen, message, size)) {
            return false;
        }
        at.text = stop + 1;
    }
    return true;
}
