#include "tests/api/history.h"

bench_reply history_post(api_bench *b, const char *what, const char *body)
{
    char target[TARGET];
    snprintf(target, sizeof target, "/v1/meshes/m/%s", what);
    return bench_send(b, "POST", target, NULL, body);
}

double history_number(const cJSON *object, const char *name)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, name);
    assert_true(cJSON_IsNumber(item));
    return item->valuedouble;
}

const char *history_code(const bench_reply *r)
{
    return cJSON_GetObjectItemCaseSensitive(r->json, "code")->valuestring;
}

api_bench *history_begin(void)
{
    api_bench *b = bench_new();
    bench_done(
        bench_expect(201, bench_send(b, "PUT", "/v1/meshes/m", NULL, "{\"shape\":\"cube\"}")));
    bench_done(bench_expect(200, history_post(b, "edits", "{\"op\":\"face_poke\",\"face\":0}")));
    bench_done(bench_expect(200, history_post(b, "edits", "{\"op\":\"face_delete\",\"face\":1}")));
    bench_done(bench_expect(200, history_post(b, "undo", NULL)));
    return b;
}
