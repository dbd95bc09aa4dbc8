#include "server/http/syntax/http_fault.h"

#include "api/limits.h"

void srv_fault_describe(srv_fault fault, api_problem *problem)
{
    static const struct {
        int code;
        const char *text;
        int limit;
    } rows[] = {
#define SRV_FAULT_ROW(constant, code, text, limit) {API_##code, text, limit},
        SRV_FAULT_MAP(SRV_FAULT_ROW)
#undef SRV_FAULT_ROW
    };
    size_t row = (size_t)fault - 1;
    if (rows[row].limit > 0) {
        api_problem_set(problem, rows[row].code, "%s: at most %d", rows[row].text, rows[row].limit);
    } else {
        api_problem_set(problem, rows[row].code, "%s", rows[row].text);
    }
}
