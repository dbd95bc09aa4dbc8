#include "api/limit/limit.h"

#include <string.h>

static const struct {
    const char *name;
    bool is_bytes, is_of_token;
} rows[API_LIMIT_COUNT] = {
#define ROW(constant, word, bytes, token) [API_LIMIT_##constant] = {word, bytes, token},
    API_LIMIT_MAP(ROW)
#undef ROW
};

const char *api_limit_name(api_limit limit)
{
    return rows[limit].name;
}

bool api_limit_is_bytes(api_limit limit)
{
    return rows[limit].is_bytes;
}

bool api_limit_is_of_token(api_limit limit)
{
    return rows[limit].is_of_token;
}

static bool read_unit(char unit, uint64_t *out)
{
    static const char units[] = "KMGT";
    const char *at = unit == '\0' ? NULL : strchr(units, unit >= 'a' ? unit - 'a' + 'A' : unit);
    *out = at == NULL ? 0 : UINT64_C(1) << (10 * (at - units + 1));
    return at != NULL;
}

bool api_amount_parse(const char *text, size_t length, bool bytes, uint64_t *out)
{
    uint64_t value = 0, unit = 1;
    size_t digits = 0;
    for (; digits < length && text[digits] >= '0' && text[digits] <= '9'; digits++) {
        if (value > (UINT64_MAX - 9) / 10) {
            return false;
        }
        value = value * 10 + (uint64_t)(text[digits] - '0');
    }
    const bool has_unit = bytes && digits + 1 == length;
    return digits > 0 && (has_unit ? read_unit(text[digits], &unit) : digits == length) &&
           !__builtin_mul_overflow(value, unit, out);
}

void api_limited_count(api_limited *limited, api_client_kind kind, api_limit limit)
{
    atomic_fetch_add_explicit(&limited->refused[kind][limit], 1, memory_order_relaxed);
}

uint64_t api_limited_get(const api_limited *limited, api_client_kind kind, api_limit limit)
{
    return atomic_load_explicit(&limited->refused[kind][limit], memory_order_relaxed);
}

const char *api_client_kind_name(api_client_kind kind)
{
    return kind == API_CLIENT_TOKEN ? "token" : "address";
}
