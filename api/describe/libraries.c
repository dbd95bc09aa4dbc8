#include "api/describe/libraries.h"

#include "api/header/compression.h"

#include <cjson/cJSON.h>

void api_libraries_list(api_library out[API_LIBRARIES])
{
    out[0] = (api_library){"cJSON", cJSON_Version()};
    out[1] = (api_library){"zlib", zlibVersion()};
    out[2] = (api_library){"zstd", ZSTD_versionString()};
}
