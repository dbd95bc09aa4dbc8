#include "server/log/trace.h"

#include "system/random.h"

#include <stdbool.h>
#include <string.h>

void srv_spans_init(srv_spans *spans)
{
    spans->seed = st_random();
    atomic_init(&spans->next, 1);
}

/* Mixes the bits of a number as SplitMix64 does (Steele, Lea, Flood 2014). It is a bijection, so
 * two numbers never give the same id. */
static uint64_t mix(uint64_t z)
{
    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return z ^ z >> 31;
}

/* Makes a span id of 16 digits that are not all zero, which would be invalid. */
static void put_new_id(srv_spans *spans, char out[SRV_SPAN_ID])
{
    uint64_t id = 0;
    while (id == 0) {
        const uint64_t number = atomic_fetch_add_explicit(&spans->next, 1, memory_order_relaxed);
        id = mix(spans->seed + number * UINT64_C(0x9e3779b97f4a7c15));
    }
    for (size_t i = 0; i < SRV_SPAN_ID; i++) {
        out[i] = "0123456789abcdef"[id >> (60 - 4 * i) & 15];
    }
}

static bool is_digits(const char *text, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (!((text[i] >= '0' && text[i] <= '9') || (text[i] >= 'a' && text[i] <= 'f'))) {
            return false;
        }
    }
    return true;
}

static bool is_zero(const char *text, size_t count)
{
    return strspn(text, "0") >= count;
}

/* The offsets of the fields in a traceparent of version 00. */
enum { TRACE_AT = 3, PARENT_AT = 36, FLAGS_AT = 53 };

static bool is_well_formed(const char *value, size_t length)
{
    if (length < SRV_TRACEPARENT || !is_digits(value, 2) || memcmp(value, "ff", 2) == 0) {
        return false;
    }
    const bool ends =
        length == SRV_TRACEPARENT || (memcmp(value, "00", 2) != 0 && value[SRV_TRACEPARENT] == '-');
    return ends && value[TRACE_AT - 1] == '-' && value[PARENT_AT - 1] == '-' &&
           value[FLAGS_AT - 1] == '-' && is_digits(value + TRACE_AT, SRV_TRACE_ID) &&
           is_digits(value + PARENT_AT, SRV_SPAN_ID) && is_digits(value + FLAGS_AT, 2) &&
           !is_zero(value + TRACE_AT, SRV_TRACE_ID) && !is_zero(value + PARENT_AT, SRV_SPAN_ID);
}

void srv_trace_read(srv_spans *spans, const char *value, size_t count, srv_trace *out)
{
    *out = (srv_trace){.trace_id = ""};
    if (count == 0) {
        return;
    }
    char flag = '0';
    if (count == 1 && is_well_formed(value, strlen(value))) {
        memcpy(out->trace_id, value + TRACE_AT, SRV_TRACE_ID);
        memcpy(out->parent_id, value + PARENT_AT, SRV_SPAN_ID);
        /* Version 00 defines only the lowest bit of the flags; the other bits must not be
         * copied. */
        flag = strchr("13579bdf", value[FLAGS_AT + 1]) != NULL ? '1' : '0';
    } else {
        put_new_id(spans, out->trace_id);
        put_new_id(spans, out->trace_id + SRV_SPAN_ID);
    }
    put_new_id(spans, out->span_id);
    char *at = out->answered;
    memcpy(at, "00-", TRACE_AT);
    memcpy(at + TRACE_AT, out->trace_id, SRV_TRACE_ID);
    at[PARENT_AT - 1] = '-';
    memcpy(at + PARENT_AT, out->span_id, SRV_SPAN_ID);
    memcpy(at + FLAGS_AT - 1, "-0", 2);
    at[SRV_TRACEPARENT - 1] = flag;
    at[SRV_TRACEPARENT] = '\0';
}
