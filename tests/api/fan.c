#include "tests/api/fan.h"

fan_text fan_text_new(size_t room)
{
    fan_text t = {malloc(room), 0, room};
    assert_non_null(t.bytes);
    return t;
}

void fan_add(fan_text *t, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    t->length += (size_t)vsnprintf(t->bytes + t->length, t->room - t->length, format, list);
    va_end(list);
    assert_true(t->length < t->room);
}

void fan_put(api_bench *b, const char *path, int spokes, int stride)
{
    fan_text t = fan_text_new(128 * (size_t)spokes);
    fan_add(&t, "{\"vertices\":[[0,0,0]");
    for (int i = 0; i < spokes; i++) {
        double turn = 2 * 3.141592653589793 * fmod((double)i * stride, spokes) / spokes;
        fan_add(&t, ",[%.17g,%.17g,%.17g]", cos(turn), sin(turn), cos(turn) / 3);
    }
    fan_add(&t, "],\"faces\":[");
    for (int i = 0; i < spokes; i++) {
        fan_add(&t, "%s[0,%d,%d]", i == 0 ? "" : ",", i + 1, (i + 1) % spokes + 1);
    }
    fan_add(&t, "]}");
    bench_reply r = bench_send(b, "PUT", path, NULL, t.bytes);
    assert_true(r.status == 201 || r.status == 200);
    bench_reply_free(&r);
    free(t.bytes);
}
