#include "base/status.h"

#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>

static const struct {
    const char *slug, *title;
} statuses[HE_STATUS_COUNT] = {
#define HE_STATUS_ROW(constant, slug, title) {slug, title},
    HE_STATUS_MAP(HE_STATUS_ROW)
#undef HE_STATUS_ROW
};

static const struct {
    const char *name, *plural;
} kinds[HE_KIND_COUNT + 1] = {
    {"vertex", "vertices"}, {"halfedge", "halfedges"}, {"edge", "edges"},
    {"face", "faces"},      {"mesh", "mesh"},          {"none", "none"},
};

const char *he_status_slug(he_status status)
{
    return statuses[status].slug;
}

const char *he_status_title(he_status status)
{
    return statuses[status].title;
}

const char *he_kind_name(he_kind kind)
{
    return kinds[kind].name;
}

const char *he_kind_plural(he_kind kind)
{
    return kinds[kind].plural;
}

static void fill(he_error *err, he_error value, const char *format, va_list arguments)
{
    if (err != NULL) {
        vsnprintf(value.text, sizeof value.text, format, arguments);
        *err = value;
    }
}

he_status he_fail(he_error *err, he_status status, he_kind kind, uint32_t id, const char *format,
                  ...)
{
    va_list arguments;
    va_start(arguments, format);
    fill(err, (he_error){.status = status, .kind = kind, .id = id}, format, arguments);
    va_end(arguments);
    return status;
}

he_status he_fail_plain(he_error *err, he_status status, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fill(err, (he_error){.status = status, .kind = HE_KIND_COUNT}, format, arguments);
    va_end(arguments);
    return status;
}

he_status he_fail_at(he_error *err, he_status status, he_place place, uint64_t at,
                     const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fill(err, (he_error){.status = status, .kind = HE_KIND_COUNT, .place = place, .at = at}, format,
         arguments);
    va_end(arguments);
    return status;
}
