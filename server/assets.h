/* assets.h - the files of the web page, read into memory once at the start.
 *
 * The files are in a folder that `make page` has made. index.html is served as "/", the manual
 * docs.html (if it exists) as "/docs", docs/NAME.html as "/docs/NAME", docs/PART/NAME.html as
 * "/docs/PART/NAME", and the regular files of assets/ as "/assets/NAME". Symbolic links are not
 * followed and other files are not read. Requests are answered from memory and never reach the file
 * system, so files that are changed later are served as they were. If there is no such folder, "/"
 * is a plain notice. */
#ifndef HE_SERVER_ASSETS_H
#define HE_SERVER_ASSETS_H

#include "api/request/api.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct srv_assets srv_assets;

enum { SRV_ASSET_COUNT = 1024, SRV_ASSET_BYTES = 64 << 20 };

/* Reads the files of the page from `folder`; NULL if there is no such folder. Returns NULL when
 * memory is out. If the folder cannot be used, `message` says why; otherwise `message` is "". */
srv_assets *srv_assets_load(const char *folder, char *message, size_t size);
void srv_assets_free(srv_assets *assets);
/* Returns the file that is served under a path, or NULL if there is no such file. The function is
 * the `asset` of api_options; `context` is the srv_assets. */
const api_asset *srv_assets_find(void *context, const char *path);

/* Writes the path of the folder of the page to `out`: `configured`, if it is not "", or else the
 * folder web or ../share/hedge/web relative to that of the executable. Returns false if no folder
 * exists. */
bool srv_assets_folder(const char *configured, char *out, size_t size);

#endif
