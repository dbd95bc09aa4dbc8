/* config_file.h - settings in a file, one per line.
 *
 *     # which addresses can reach it
 *     listen = 0.0.0.0:8080
 *     allow-host = meshes.example.com
 *     samples
 *
 * Names are those of the flags without dashes, and values are written as for flags; --print-config
 * prints such lines. Blanks around names and values, empty lines and lines that begin with # are
 * ignored. A switch needs no value; several lines of a list option add up. */
#ifndef HE_SERVER_CONFIG_FILE_H
#define HE_SERVER_CONFIG_FILE_H

#include "server/config.h"

/* Reads settings from a file. Returns false with a sentence in `message`, which begins with the
 * file and the line. `config` owns the text until srv_config_clear. */
bool srv_config_read_file(srv_config *config, const char *path, char *message, size_t size);

#endif
