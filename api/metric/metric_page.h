/* metric_page.h - metrics as text: Prometheus' exposition format, version 0.0.4.
 *
 *     # HELP hedge_meshes Meshes that there are, in memory or not.
 *     # TYPE hedge_meshes gauge
 *     hedge_meshes 12
 *
 * api_metric_begin writes the two comment lines of a metric from its row in metric_rows.h. The
 * samples of the metric must follow; each has the values of the row's labels in the order of the
 * labels. Failure is sticky (text.h): after a write has failed, all later writes are ignored. */
#ifndef HE_API_METRIC_METRIC_PAGE_H
#define HE_API_METRIC_METRIC_PAGE_H

#include "api/json/text.h"
#include "api/metric/metric_rows.h"
#include "system/histogram.h"

#include <stddef.h>

typedef enum api_metric_type {
    API_METRIC_COUNTER,
    API_METRIC_GAUGE,
    API_METRIC_HISTOGRAM
} api_metric_type;

/* The description of a metric: a row of metric_rows.h. */
typedef struct api_metric {
    const char *name;
    api_metric_type type;
    const char *labels; /* names of the metric's labels, separated by commas; "" if it has none */
    const char *help;
} api_metric;

typedef enum api_metric_id {
#define API_METRIC_ENUM(constant, name, type, labels, help) API_METRIC_ID_##constant,
    API_METRIC_MAP(API_METRIC_ENUM)
#undef API_METRIC_ENUM
        API_METRIC_COUNT
} api_metric_id;

const api_metric *api_metric_at(api_metric_id id);

typedef struct api_metric_page {
    api_text *text;
    const api_metric *row; /* the metric whose samples are being written */
} api_metric_page;

enum { API_METRIC_LABELS = 3 };

void api_metric_begin(api_metric_page *page, api_metric_id id);
/* Writes a sample of a metric. `values` has a value for each label of the metric's row; NULL if it
 * has no labels. */
void api_metric_put(api_metric_page *page, const char *const *values, double number);
/* Writes a histogram. `scale` has the upper bounds of its buckets. The bounds and the sum are
 * written divided by `unit`: 1e6, for example, writes microseconds as seconds. */
void api_metric_put_histogram(api_metric_page *page, const char *const *values,
                              const st_distribution *distribution, const uint64_t scale[ST_BOUNDS],
                              double unit);

#endif
