#include "server/boot/start.h"

#include "api/describe/libraries.h"
#include "journal/sqlite/sqlite_journal.h"
#include "server/config_option.h"
#include "server/http/http.h"
#include "server/version.h"

#include <unistd.h>

static bool is_terminal(void)
{
    return isatty(STDERR_FILENO) != 0;
}

bool srv_start_is_json(const srv_config *config)
{
    return config->log_format == SRV_FORMAT_JSON ||
           (config->log_format == SRV_FORMAT_AUTO && !is_terminal());
}

srv_log_settings srv_start_log_settings(const srv_config *config)
{
    return (srv_log_settings){
        .level = (srv_level)config->log_level,
        .json = srv_start_is_json(config),
        .requests =
            config->log == SRV_LOG_ACCESS || (config->log == SRV_LOG_AUTO && !is_terminal()),
        .slow_us = config->slow * 1000,
    };
}

static void tell_versions(srv_log *log)
{
    api_library libraries[API_LIBRARIES];
    srv_line line;
    srv_log_begin(log, &line, SRV_LEVEL_INFO, "hedged starts");
    srv_line_text(&line, "version", SRV_VERSION);
    srv_line_text(&line, "commit", srv_commit);
    srv_line_number(&line, "pid", (uint64_t)getpid());
    srv_line_open(&line, "libraries");
    srv_line_text(&line, "libmicrohttpd", srv_http_library());
    srv_line_text(&line, "SQLite", st_sqlite_library());
    api_libraries_list(libraries);
    for (size_t i = 0; i < API_LIBRARIES; i++) {
        srv_line_text(&line, libraries[i].name, libraries[i].version);
    }
    srv_line_close(&line);
    srv_log_end(log, &line);
}

static void tell_options(srv_log *log, const srv_config *config)
{
    api_text value = {0};
    srv_line line;
    srv_log_begin(log, &line, SRV_LEVEL_INFO, "options in effect");
    srv_line_open(&line, "options");
    for (size_t i = 0; i < srv_option_count; i++) {
        const srv_option *row = &srv_options[i];
        if (srv_option_is_setting(row) || row->kind == SRV_SOURCE) {
            api_text_empty(&value);
            srv_option_write(row, config, &value);
            api_text_add_char(&value, '\0');
            srv_line_text(&line, row->name, value.failed ? "" : value.bytes);
        }
    }
    srv_line_close(&line);
    srv_log_end(log, &line);
    api_text_clear(&value);
}

void srv_start_tell(srv_log *log, const srv_config *config, char *const *environment)
{
    char names[SRV_MESSAGE / 2];
    tell_versions(log);
    tell_options(log, config);
    if (srv_config_find_unknown(environment, names, sizeof names) > 0) {
        srv_log_tell(log, SRV_LEVEL_WARNING,
                     "environment variables that belong to no option are ignored: %s; --help lists "
                     "the options",
                     names);
    }
}
