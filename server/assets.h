/* assets.h - the files of the web page, read into memory once at the start.
 *
 * They lie in a folder made by `make page`. index.html is served as "/", docs.html (if it exists)
 * as "/docs", and the regular files of assets/ as "/assets/NAME". Links are not followed and other
 * files are not read, so a request can never reach the file system. Without a folder "/" is a plain
 * notice. */
#ifndef HE_SERVER_ASSETS_H
#define HE_SERVER_ASSETS_H

#include "api/request/api.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct srv_assets srv_assets;

enum { SRV_ASSET_COUNT = 512, SRV_ASSET_BYTES = 64 << 20 };

/* Reads the files of the page. Returns NULL when memory is out. If the folder cannot be used,
 * `message` says why; otherwise it is "". */
srv_assets *srv_assets_load(const char *folder, char *message, size_t size);
void srv_assets_free(srv_assets *assets);
/* Finds the file of a path, as the `asset` of api_options; `context` is the srv_assets. */
const api_asset *srv_assets_find(void *context, const char *path);

/* Finds the folder of the page: `configured`, or web beside the executable, or ../share/hedge/web
 * from there. Returns false if there is none. */
bool srv_assets_folder(const char *configured, char *out, size_t size);

#endif
