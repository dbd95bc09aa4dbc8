#include "api/header/content_coding.h"

#include "api/header/media.h"

#include <stddef.h>
#include <string.h>

const char *const api_codings_taken[] = {"gzip", "zstd", "identity", NULL};
const char api_codings_list[] = "gzip, zstd";

const char *api_coding_name(api_coding coding)
{
    static const char *const names[API_CODING_COUNT] = {"zstd", "gzip", "identity"};
    return names[coding];
}

static bool find_name(const char *name, api_coding *out)
{
    if (api_equal_nocase(name, "x-gzip")) {
        *out = API_GZIP;
        return true;
    }
    for (api_coding c = 0; c < API_CODING_COUNT; c++) {
        if (api_equal_nocase(name, api_coding_name(c))) {
            *out = c;
            return true;
        }
    }
    return false;
}

bool api_coding_of_body(const char *content_encoding, api_coding *out)
{
    api_weighed item;
    bool found = false;
    *out = API_IDENTITY;
    if (content_encoding != NULL && strchr(content_encoding, ';') != NULL) {
        return false;
    }
    for (const char *at = content_encoding; api_media_next(&at, &item);) {
        if (found || !find_name(item.name, out)) {
            return false;
        }
        found = true;
    }
    return true;
}

bool api_coding_choose(const char *accept_encoding, api_codings *out)
{
    /* The weights (q) are in thousandths; -1 means that the header does not name the coding.
     * `others` is the weight of "*". */
    int q[API_CODING_COUNT] = {-1, -1, -1}, others = -1;
    api_weighed item;
    for (const char *at = accept_encoding; api_media_next(&at, &item);) {
        api_coding coding;
        if (item.q < 0) {
            continue;
        }
        if (strcmp(item.name, "*") == 0) {
            others = item.q;
        } else if (find_name(item.name, &coding) && item.q > q[coding]) {
            q[coding] = item.q;
        }
    }
    *out = (api_codings){.best = API_IDENTITY};
    bool any = false;
    int most = 0;
    for (api_coding c = 0; c < API_CODING_COUNT; c++) {
        int weight = q[c] >= 0 ? q[c] : c == API_ZSTD ? -1 : others;
        if (weight < 0) {
            /* The header does not name identity, so identity is allowed, with the lowest
             * preference. */
            weight = c == API_IDENTITY ? 1 : 0;
        }
        out->allowed[c] = weight > 0;
        any = any || weight > 0;
        if (weight > most) {
            most = weight;
            out->best = c;
        }
    }
    if (!any && q[API_ZSTD] < 0 && others > 0) {
        out->allowed[API_ZSTD] = any = true;
        out->best = API_ZSTD;
    }
    return any;
}
