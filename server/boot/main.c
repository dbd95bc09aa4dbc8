#include "server/boot/daemon.h"
#include "server/boot/start.h"
#include "server/config.h"
#include "server/maintenance.h"
#include "server/net/healthcheck.h"
#include "server/tokens.h"
#include "server/version.h"
#include "system/memory.h"

#include <stdlib.h>
#include <unistd.h>

enum { MISUSE = 2 };

/* The third parameter of main, the environment, is not in the C standard, but all systems that
 * hedged runs on have it. */
int main(int argc, char **argv, char **environment)
{
    srv_config config;
    char message[320], url[SRV_URL_TEXT];
    int status = 0;
    st_memory_install(0);
    const srv_config_sources from = {argc - 1, argv + 1, getenv};
    if (!srv_config_read(&config, &from, message, sizeof message)) {
        srv_line_write(STDERR_FILENO, srv_start_is_json(&config), SRV_LEVEL_ERROR, message);
        return MISUSE;
    }
    if (config.help) {
        srv_config_help(stdout);
    } else if (config.version) {
        printf("hedged " SRV_VERSION "%s%s%s\n", srv_commit[0] == '\0' ? "" : " (commit ",
               srv_commit, srv_commit[0] == '\0' ? "" : ")");
    } else if (config.print_config) {
        srv_config_print(&config, stdout);
    } else if (config.healthcheck) {
        srv_config_url(&config, NULL, url);
        if (!srv_healthcheck(config.healthcheck_url == NULL ? url : config.healthcheck_url, message,
                             sizeof message)) {
            fprintf(stderr, "hedged: %s\n", message);
            status = 1;
        }
    } else if (config.new_token) {
        status = srv_tokens_new(config.token_name == NULL ? "token" : config.token_name,
                                config.token_role == NULL ? "read" : config.token_role);
    } else if (srv_maintenance_asked(&config)) {
        status = srv_maintenance_run(&config);
    } else {
        status = srv_daemon_run(&(srv_started){
            .config = &config, .argc = argc - 1, .argv = argv + 1, .environment = environment});
    }
    srv_config_clear(&config);
    return status;
}
