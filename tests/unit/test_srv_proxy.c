/* Tests of the facts about a client (such as its address) that the server takes from the headers of
 * a trusted proxy, and of the headers that the server must not believe if the client itself sends
 * them. */
#include "tests/unit/fixture.h"

#include "server/net/proxy.h"

static srv_proxies proxies_of(const char *const *texts)
{
    srv_proxies proxies = {0};
    for (; *texts != NULL; texts++) {
        assert_true(srv_proxies_add(&proxies, *texts));
    }
    return proxies;
}

static void a_proxy_is_an_address_a_network_or_the_unix_socket(void **state)
{
    (void)state;
    const srv_proxies proxies = proxies_of(
        (const char *const[]){"10.1.0.0/16", "192.0.2.7", "2001:db8::/33", "unix", NULL});
    static const char *const in[] = {"10.1.255.1", "192.0.2.7", "2001:db8:7fff::1", "unix:uid=7"};
    static const char *const out[] = {"10.2.0.1", "192.0.2.8", "2001:db8:8000::1", "::1", "-", ""};
    for (size_t i = 0; i < sizeof in / sizeof *in; i++) {
        assert_true(srv_proxies_has(&proxies, in[i]));
    }
    for (size_t i = 0; i < sizeof out / sizeof *out; i++) {
        assert_false(srv_proxies_has(&proxies, out[i]));
    }
    const srv_proxies all = proxies_of((const char *const[]){"0.0.0.0/0", NULL});
    assert_true(srv_proxies_has(&all, "203.0.113.9"));
    assert_false(srv_proxies_has(&all, "::1"));
    assert_false(srv_proxies_has(&all, "unix:uid=0"));
}

static void what_is_no_network_is_refused(void **state)
{
    (void)state;
    static const char *const bad[] = {
        "",        "localhost",   "10.0.0",       "10.0.0.0/33", "10.0.0.0/",
        "::1/129", "10.0.0.0/-1", "10.0.0.0/8x",  "[::1]",       "10.0.0.1:5",
        "unix/3",  "unix:/run/x", "10.0.0.0/0008"};
    srv_proxies proxies = {0};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        if (srv_proxies_add(&proxies, bad[i])) {
            fail_msg("\"%s\" was taken for a proxy", bad[i]);
        }
    }
    for (size_t i = 0; i < SRV_MAX_PROXIES; i++) {
        assert_true(srv_proxies_add(&proxies, "10.0.0.1"));
    }
    assert_false(srv_proxies_add(&proxies, "10.0.0.1"));
}

typedef struct told {
    const char *lines[3]; /* header lines of the request, each in the form "Name: value" */
    const char *address;  /* expected address of the client; NULL if the request must be refused */
    srv_scheme scheme;
} told;

static void check(const told *row)
{
    const srv_proxies proxies = proxies_of((const char *const[]){"10.0.0.0/8", "fd00::/8", NULL});
    srv_forwarding read = {0};
    char address[SRV_ADDRESS_TEXT] = "10.0.0.1";
    srv_scheme scheme = SRV_SCHEME_UNKNOWN;
    for (size_t i = 0; i < 3 && row->lines[i] != NULL; i++) {
        char name[32];
        const char *colon = strchr(row->lines[i], ':');
        snprintf(name, sizeof name, "%.*s", (int)(colon - row->lines[i]), row->lines[i]);
        srv_forwarding_read(&read, &proxies, name, colon + 2);
    }
    const char *wrong = srv_forwarding_end(&read, address, &scheme);
    if ((wrong == NULL) != (row->address != NULL)) {
        fail_msg("%s: %s", row->lines[0], wrong == NULL ? "was taken" : wrong);
    }
    assert_string_equal(address, wrong == NULL ? row->address : "10.0.0.1");
    assert_int_equal(scheme, wrong == NULL ? row->scheme : SRV_SCHEME_UNKNOWN);
}

static void the_last_address_that_is_no_proxy_is_the_clients(void **state)
{
    (void)state;
    const srv_scheme none = SRV_SCHEME_UNKNOWN, http = SRV_SCHEME_HTTP, https = SRV_SCHEME_HTTPS;
    const told rows[] = {
        {{"X-Forwarded-For: 192.0.2.1"}, "192.0.2.1", none},
        {{"x-forwarded-for: 192.0.2.1:4711"}, "192.0.2.1", none},
        {{"X-Forwarded-For: 2001:DB8::0:1"}, "2001:db8::1", none},
        {{"X-Forwarded-For: [2001:db8::1]:80"}, "2001:db8::1", none},
        {{"X-Forwarded-For: 6.6.6.6, 192.0.2.1"}, "192.0.2.1", none},
        {{"X-Forwarded-For: 6.6.6.6, 192.0.2.1 , 10.0.0.9,fd00::1"}, "192.0.2.1", none},
        {{"X-Forwarded-For: 10.6.6.6, 10.0.0.9"}, "10.6.6.6", none},
        {{"X-Forwarded-For: nonsense, 192.0.2.1, 10.0.0.9"}, "192.0.2.1", none},
        {{"X-Forwarded-For: 6.6.6.6", "X-Forwarded-For: 192.0.2.1"}, "192.0.2.1", none},
        {{"X-Forwarded-For: , 192.0.2.1, ,"}, "192.0.2.1", none},
        {{"X-Forwarded-For: "}, "10.0.0.1", none},
        {{"X-Forwarded-Proto: https"}, "10.0.0.1", https},
        {{"X-Forwarded-Proto: https, http"}, "10.0.0.1", http},
        {{"X-Forwarded-For: 192.0.2.1", "X-Forwarded-Proto: HTTPS"}, "192.0.2.1", https},
        {{"X-Real-Ip: 6.6.6.6"}, "10.0.0.1", none},

        {{"Forwarded: for=192.0.2.1"}, "192.0.2.1", none},
        {{"forwarded: FOR=\"192.0.2.1:80\";Proto=https;by=_me;host=x"}, "192.0.2.1", https},
        {{"Forwarded: for=\"[2001:db8::1]:80\""}, "2001:db8::1", none},
        {{"Forwarded: for=6.6.6.6;proto=https, for=192.0.2.1;proto=http"}, "192.0.2.1", http},
        {{"Forwarded: for=192.0.2.1;proto=https, for=10.0.0.9;proto=http"}, "192.0.2.1", https},
        {{"Forwarded: for=6.6.6.6;proto=https, for=192.0.2.1"}, "192.0.2.1", none},
        {{"Forwarded: for=6.6.6.6", "Forwarded: for=192.0.2.1"}, "192.0.2.1", none},
        {{"Forwarded: for=6.6.6.6, for=unknown;proto=https"}, "10.0.0.1", https},
        {{"Forwarded: for=6.6.6.6, for=_hidden, for=10.0.0.9"}, "10.0.0.1", none},
        {{"Forwarded: for=6.6.6.6, proto=https"}, "10.0.0.1", https},
        {{"Forwarded: for=6.6.6.6;x=\"a,\\\"b\", for=192.0.2.1"}, "192.0.2.1", none},
        {{"Forwarded: ,, for=192.0.2.1 ; proto=http ,"}, "192.0.2.1", http},

        {{"Forwarded: for=192.0.2.1;proto=https", "X-Forwarded-For: 192.0.2.1",
          "X-Forwarded-Proto: https"},
         "192.0.2.1",
         https},
        {{"Forwarded: for=unknown", "X-Forwarded-For: 192.0.2.1"}, "192.0.2.1", none},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        check(&rows[i]);
    }
}

static void what_is_not_well_formed_or_disagrees_is_refused(void **state)
{
    (void)state;
    static const told rows[] = {
        {{"X-Forwarded-For: nonsense"}, NULL, 0},
        {{"X-Forwarded-For: 192.0.2.1, unknown"}, NULL, 0},
        {{"X-Forwarded-For: 192.0.2.1, unknown, 10.0.0.9"}, NULL, 0},
        {{"X-Forwarded-For: 192.0.2.1:"}, NULL, 0},
        {{"X-Forwarded-For: 192.0.2.1:99999"}, NULL, 0},
        {{"X-Forwarded-For: [192.0.2.1]"}, NULL, 0},
        {{"X-Forwarded-For: [2001:db8::1"}, NULL, 0},
        {{"X-Forwarded-For: [2001:db8::1]x"}, NULL, 0},
        {{"X-Forwarded-For: 2001:db8::1]"}, NULL, 0},
        {{"X-Forwarded-For: 192.0.2.1 10.0.0.9"}, NULL, 0},
        {{"X-Forwarded-For: 1111111111111111111111111111111111111111111111111111111111111111111"},
         NULL,
         0},
        {{"X-Forwarded-Proto: ftp"}, NULL, 0},
        {{"X-Forwarded-Proto: https, wss"}, NULL, 0},

        {{"Forwarded: 192.0.2.1"}, NULL, 0},
        {{"Forwarded: for=2001:db8::1"}, NULL, 0},
        {{"Forwarded: for=192.0.2.1;for=192.0.2.2"}, NULL, 0},
        {{"Forwarded: for=192.0.2.1;proto=ftp"}, NULL, 0},
        {{"Forwarded: for =192.0.2.1"}, NULL, 0},
        {{"Forwarded: for=6.6.6.6;x=\", for=192.0.2.1"}, NULL, 0},
        {{"Forwarded: for=6.6.6.6;x=\", for=\"192.0.2.1\""}, NULL, 0},
        {{"Forwarded: for=6.6.6.6;x=\"\\"}, NULL, 0},
        {{"Forwarded: for=\"", "Forwarded: for=192.0.2.1"}, NULL, 0},
        {{"Forwarded: for=192.0.2.1 proto=https"}, NULL, 0},

        {{"Forwarded: for=6.6.6.6", "X-Forwarded-For: 192.0.2.1"}, NULL, 0},
        {{"Forwarded: for=192.0.2.1;proto=http", "X-Forwarded-Proto: https"}, NULL, 0},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        check(&rows[i]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_proxy_is_an_address_a_network_or_the_unix_socket),
        cmocka_unit_test(what_is_no_network_is_refused),
        cmocka_unit_test(the_last_address_that_is_no_proxy_is_the_clients),
        cmocka_unit_test(what_is_not_well_formed_or_disagrees_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
