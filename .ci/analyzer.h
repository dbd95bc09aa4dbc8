/* analyzer.h - included first by .ci/lint-tidy, and never by the compiler. The analyzer sees one
 * source at a time, so it cannot know that a function which refuses returns the status that it was
 * given and never HE_OK, and that api_in_fail returns false; this header tells it. Sources that
 * need _GNU_SOURCE define it before this includes the first header. */
#define _GNU_SOURCE
#include "api/json/json_in.h"
#include "base/status.h"

#define he_fail(err, status, ...)       ((void)(he_fail)(err, status, __VA_ARGS__), (status))
#define he_fail_plain(err, status, ...) ((void)(he_fail_plain)(err, status, __VA_ARGS__), (status))
#define he_fail_at(err, status, ...)    ((void)(he_fail_at)(err, status, __VA_ARGS__), (status))
#define api_in_fail(...)                ((void)(api_in_fail)(__VA_ARGS__), false)
