#include "tests/api/strip.h"

void strip_send(api_bench *b, int status, const char *method, const char *target, const char *body)
{
    bench_reply r = bench_expect(status, bench_send(b, method, target, NULL, body));
    bench_reply_free(&r);
}

void strip_make(api_bench *b, const char *id, bool edited)
{
    char target[64];
    snprintf(target, sizeof target, "/v1/meshes?id=%s", id);
    strip_send(b, 201, "POST", target,
               "{\"vertices\":[[0,0,0],[1,0,0],[2,0,0],[0,1,0],[1,1,0],[2,1,0],[5,5,5]],"
               "\"faces\":[[0,1,4,3],[1,2,5,4]]}");
    if (edited) {
        snprintf(target, sizeof target, "/v1/meshes/%s/edits", id);
        strip_send(
            b, 200, "POST", target,
            "{\"ops\":[{\"op\":\"face_poke\",\"face\":1},{\"op\":\"face_delete\",\"face\":2},"
            "{\"op\":\"edge_bisect\",\"edge\":0},{\"op\":\"vertex_delete\",\"vertex\":6}]}");
    }
}
