/* config_file.h - settings in a file, one a line.
 *
 *     # who may reach it
 *     listen = 0.0.0.0:8080
 *     allow-host = meshes.example.com
 *     samples
 *
 * The names are those of the flags without the dashes, the values as flags take them;
 * --print-config writes such lines. Blanks around names and values do not count, nor do empty lines
 * and those that begin with #. A switch may stand alone; the lines of a list add up. */
#ifndef HE_SERVER_CONFIG_FILE_H
#define HE_SERVER_CONFIG_FILE_H

#include "server/config.h"

/* False with a sentence in `message`, which begins with the file and the line. The text stays in
 * `config` until srv_config_clear. */
bool srv_config_read_file(srv_config *config, const char *path, char *message, size_t size);

#endif
