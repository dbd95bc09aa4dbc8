#include "api/metric/metric_page.h"

#include "format/text/number.h"

#include <string.h>

static const api_metric rows[API_METRIC_COUNT] = {
#define METRIC_ROW(constant, name, type, labels, help) \
    [API_METRIC_ID_##constant] = {name, API_METRIC_##type, labels, help},
    API_METRIC_MAP(METRIC_ROW)
#undef METRIC_ROW
};

static const char *const type_names[] = {
    [API_METRIC_COUNTER] = "counter",
    [API_METRIC_GAUGE] = "gauge",
    [API_METRIC_HISTOGRAM] = "histogram",
};

const api_metric *api_metric_at(api_metric_id id)
{
    return &rows[id];
}

void api_metric_begin(api_metric_page *page, api_metric_id id)
{
    page->row = &rows[id];
    api_text_add_format(page->text, "# HELP %s %s\n# TYPE %s %s\n", page->row->name,
                        page->row->help, page->row->name, type_names[page->row->type]);
}

static void put_value(api_text *text, const char *value)
{
    for (; *value != '\0'; value++) {
        if (*value == '\\' || *value == '"') {
            api_text_add_char(text, '\\');
        }
        api_text_add_char(text, *value);
    }
}

/* Writes the labels of a sample, such as {method="GET",route="/"}; `bound` is the value of the
 * label "le", or NULL. */
static void put_labels(const api_metric_page *page, const char *const *values, const char *bound)
{
    api_text *text = page->text;
    char before = '{';
    for (const char *name = page->row->labels; *name != '\0'; values++) {
        size_t length = strcspn(name, ",");
        api_text_add_char(text, before);
        api_text_add(text, name, length);
        api_text_add_string(text, "=\"");
        put_value(text, *values);
        api_text_add_char(text, '"');
        before = ',';
        name += length + (name[length] == ',' ? 1 : 0);
    }
    if (bound != NULL) {
        api_text_add_char(text, before);
        api_text_add_format(text, "le=\"%s\"", bound);
        before = ',';
    }
    if (before == ',') {
        api_text_add_char(text, '}');
    }
}

static const char *print(double number, char out[HE_NUMBER_TEXT + 1])
{
    out[he_double_print(number, out)] = '\0';
    return out;
}

static void put_sample(const api_metric_page *page, const char *suffix, const char *const *values,
                       const char *bound, double number)
{
    char text[HE_NUMBER_TEXT + 1];
    api_text_add_string(page->text, page->row->name);
    api_text_add_string(page->text, suffix);
    put_labels(page, values, bound);
    api_text_add_format(page->text, " %s\n", print(number, text));
}

void api_metric_put(api_metric_page *page, const char *const *values, double number)
{
    put_sample(page, "", values, NULL, number);
}

void api_metric_put_histogram(api_metric_page *page, const char *const *values,
                              const st_distribution *distribution, const uint64_t scale[ST_BOUNDS],
                              double unit)
{
    char bound[HE_NUMBER_TEXT + 1];
    uint64_t count = 0;
    for (size_t i = 0; i < ST_BUCKETS; i++) {
        count += distribution->buckets[i];
        put_sample(page, "_bucket", values,
                   i == ST_BOUNDS ? "+Inf" : print((double)scale[i] / unit, bound), (double)count);
    }
    put_sample(page, "_sum", values, NULL, (double)distribution->sum / unit);
    put_sample(page, "_count", values, NULL, (double)count);
}
