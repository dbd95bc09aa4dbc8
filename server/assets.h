/* assets.h - the page's files, read into memory once at the start.
 *
 * Of a folder made by `make page`: index.html is served as "/", docs.html where there is one as
 * "/docs", and the regular files of assets/ as "/assets/NAME". Links are not followed and nothing
 * else is looked at, so no request can reach a file. Without a folder "/" is a plain notice. */
#ifndef HE_SERVER_ASSETS_H
#define HE_SERVER_ASSETS_H

#include <stdbool.h>
#include <stddef.h>

typedef struct srv_assets srv_assets;

enum { SRV_ASSET_COUNT = 512, SRV_ASSET_BYTES = 64 << 20 };

/* NULL when memory is out. When the folder cannot be used, `message` (else "") says why. */
srv_assets *srv_assets_load(const char *folder, char *message, size_t size);
void srv_assets_free(srv_assets *assets);
/* api_options.asset; `context` is the srv_assets. */
bool srv_assets_find(void *context, const char *path, const char **bytes, size_t *length,
                     const char **type, const char **etag, bool *immutable);

/* The folder of the page: `configured`, or web beside the executable, or ../share/hedge/web from
 * there. False when there is none. */
bool srv_assets_folder(const char *configured, char *out, size_t size);

#endif
