#include "server/config_option.h"
#include "server/version.h"

#include <inttypes.h>
#include <string.h>

static const void *member_in(const srv_config *config, const srv_option *row)
{
    return (const char *)config + row->member;
}

void srv_config_tell_unknown(char *const *environment, FILE *out)
{
    static const char prefix[] = "HEDGE_";
    bool any = false;
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
        if (!known) {
            fprintf(out, "%s%.*s",
                    any ? ", " : "hedged: variables that no option has are ignored: ", (int)length,
                    name);
            any = true;
        }
    }
    fputs(any ? "; --help lists those there are\n" : "", out);
}

void srv_config_help(FILE *out)
{
    fprintf(out, "hedged " SRV_VERSION " - a server for half-edge meshes\n\n"
                 "usage: hedged [OPTION...]\n\n"
                 "An option wins over its environment variable, that over a line of the file that\n"
                 "--config names, that over the default.\n\n");
    for (size_t i = 0; i < srv_option_count; i++) {
        const srv_option *row = &srv_options[i];
        char variable[SRV_VARIABLE_TEXT], flag[64];
        srv_option_variable(row, variable);
        snprintf(flag, sizeof flag, "--%s%s%s", row->name, row->argument == NULL ? "" : " ",
                 row->argument == NULL ? "" : row->argument);
        fprintf(out, "  %-26s %s", flag, row->doc);
        if (!srv_option_is_switch(row) && row->fallback[0] != '\0') {
            fprintf(out, " (%s)", row->fallback);
        }
        if (srv_option_is_setting(row) || row->kind == SRV_SOURCE) {
            fprintf(out, "\n  %-26s %s", "", variable);
        }
        fputc('\n', out);
    }
}

void srv_config_print(const srv_config *config, FILE *out)
{
    for (size_t i = 0; i < srv_option_count; i++) {
        const srv_option *row = &srv_options[i];
        const void *member = member_in(config, row);
        const char *text;
        const srv_names *names;
        uint64_t number;
        bool on;
        if (!srv_option_is_setting(row)) {
            continue;
        }
        fprintf(out, "%s = ", row->name);
        switch (row->kind) {
        case SRV_TEXT:
            memcpy(&text, member, sizeof text);
            fputs(text, out);
            break;
        case SRV_LIST:
            names = member;
            for (size_t n = 0; n < names->count; n++) {
                fprintf(out, "%s%s", n == 0 ? "" : ",", names->items[n]);
            }
            break;
        case SRV_BYTES:
        case SRV_COUNT:
            memcpy(&number, member, sizeof number);
            fprintf(out, "%" PRIu64, number);
            break;
        case SRV_FLAG:
            memcpy(&on, member, sizeof on);
            fputc(on ? '1' : '0', out);
            break;
        case SRV_CHOICE:
            memcpy(&number, member, sizeof number);
            fputs(srv_log_kinds[number], out);
            break;
        case SRV_ACTION:
        case SRV_COMMAND:
        case SRV_SOURCE:
            break;
        }
        fputc('\n', out);
    }
}
