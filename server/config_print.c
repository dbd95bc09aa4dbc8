#include "server/config_option.h"
#include "server/version.h"

#include <inttypes.h>
#include <string.h>

static const void *member_in(const srv_config *config, const srv_option *row)
{
    return (const char *)config + row->member;
}

size_t srv_config_find_unknown(char *const *environment, char *names, size_t size)
{
    static const char prefix[] = "HEDGE_";
    size_t count = 0, at = 0;
    for (size_t v = 0; environment[v] != NULL; v++) {
        const char *name = environment[v];
        const size_t length = strcspn(name, "=");
        bool known = strncmp(name, prefix, sizeof prefix - 1) != 0;
        for (size_t i = 0; i < srv_option_count && !known; i++) {
            const srv_option *row = &srv_options[i];
            char variable[SRV_VARIABLE_TEXT];
            srv_option_variable(row, variable);
            known = (srv_option_is_setting(row) || row->kind == SRV_SOURCE) &&
                    strlen(variable) == length && memcmp(variable, name, length) == 0;
        }
        if (!known && at < size) {
            at += (size_t)snprintf(names + at, size - at, "%s%.*s", count == 0 ? "" : ", ",
                                   (int)length, name);
        }
        count += known ? 0 : 1;
    }
    return count;
}

/* The width of the column of --help that shows the options, in characters. An option that is longer
 * has a line of its own. */
enum { FLAG_WIDTH = 26 };

void srv_config_help(FILE *out)
{
    fprintf(out,
            "hedged " SRV_VERSION " - a server for half-edge meshes\n\n"
            "usage: hedged [OPTION...]\n\n"
            "An option overrides its environment variable, which overrides a line of the file\n"
            "of --config, which overrides the default (in parentheses).\n\n");
    for (size_t i = 0; i < srv_option_count; i++) {
        const srv_option *row = &srv_options[i];
        char variable[SRV_VARIABLE_TEXT], flag[64];
        srv_option_variable(row, variable);
        snprintf(flag, sizeof flag, "--%s%s%s", row->name, row->argument == NULL ? "" : " ",
                 row->argument == NULL ? "" : row->argument);
        if (strlen(flag) > FLAG_WIDTH) {
            fprintf(out, "  %s\n", flag);
            flag[0] = '\0';
        }
        fprintf(out, "  %-*s %s", FLAG_WIDTH, flag, row->doc);
        if (!srv_option_is_switch(row) && row->fallback[0] != '\0') {
            fprintf(out, " (%s)", row->fallback);
        }
        if (srv_option_is_setting(row) || row->kind == SRV_SOURCE) {
            fprintf(out, "\n  %-*s %s", FLAG_WIDTH, "", variable);
        }
        fputc('\n', out);
    }
}

void srv_option_write(const srv_option *row, const srv_config *config, api_text *out)
{
    const void *member = member_in(config, row);
    const char *text;
    const srv_names *names;
    uint64_t number;
    bool on;
    switch (row->kind) {
    case SRV_TEXT:
    case SRV_SOURCE:
        memcpy(&text, member, sizeof text);
        api_text_add_string(out, text);
        break;
    case SRV_LIST:
        names = member;
        for (size_t n = 0; n < names->count; n++) {
            api_text_add_string(out, n == 0 ? "" : ",");
            api_text_add_string(out, names->items[n]);
        }
        break;
    case SRV_BYTES:
    case SRV_COUNT:
        memcpy(&number, member, sizeof number);
        api_text_add_format(out, "%" PRIu64, number);
        break;
    case SRV_FLAG:
        memcpy(&on, member, sizeof on);
        api_text_add_char(out, on ? '1' : '0');
        break;
    case SRV_CHOICE:
        memcpy(&number, member, sizeof number);
        text = row->argument;
        for (; number > 0; number--) {
            text = strchr(text, '|') + 1;
        }
        api_text_add(out, text, strcspn(text, "|"));
        break;
    case SRV_ACTION:
    case SRV_COMMAND:
        break;
    }
}

void srv_config_print(const srv_config *config, FILE *out)
{
    api_text text = {0};
    for (size_t i = 0; i < srv_option_count; i++) {
        const srv_option *row = &srv_options[i];
        if (srv_option_is_setting(row)) {
            api_text_empty(&text);
            srv_option_write(row, config, &text);
            fprintf(out, "%s = %.*s\n", row->name, (int)text.length, text.bytes);
        }
    }
    api_text_clear(&text);
}
