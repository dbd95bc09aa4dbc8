/* Tests of counting the connections of each address: which addresses count as one, how many
 * connections each address has, and what happens if the table is full or memory is out. */
#include "tests/seed.h"
#include "tests/unit/fixture.h"

#include "server/net/address.h"
#include "server/net/peers.h"
#include "tests/failing.h"

static bool is_one_client(const char *a, const char *b)
{
    const api_rate_key one = srv_address_key(a), other = srv_address_key(b);
    return memcmp(&one, &other, sizeof one) == 0;
}

static void an_address_is_a_client_and_of_ipv6_a_network_is(void **state)
{
    (void)state;
    static const struct {
        const char *a, *b;
        bool same;
    } pairs[] = {
        {"192.0.2.1", "192.0.2.1", true},
        {"192.0.2.1", "192.0.2.2", false},
        {"192.0.2.1", "::ffff:192.0.2.1", true},
        {"2001:db8::1", "2001:db8::ffff:1", true},
        {"2001:db8::1", "2001:db8:0:1::1", false},
        {"2001:db8::", "::1", false},
        {"0.0.0.0", "::", false},
        {"unix:uid=0", "unix:uid=0", true},
        {"unix:uid=0", "unix:uid=1000", false},
        {"unix:uid=0", "0.0.0.0", false},
    };
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        if (is_one_client(pairs[i].a, pairs[i].b) != pairs[i].same) {
            fail_msg("%s and %s are %s client", pairs[i].a, pairs[i].b,
                     pairs[i].same ? "not one" : "one");
        }
    }
}

/* Connections come and leave at random. The counts in the table are compared with the counts in a
 * simple array. */
static void each_address_has_the_connections_that_came_and_did_not_leave(void **state)
{
    (void)state;
    enum { CONNECTIONS = 50, ADDRESSES = 80, ROUNDS = 20000 };
    struct {
        uint32_t place;
        unsigned address;
    } held[CONNECTIONS];
    size_t counts[ADDRESSES] = {0}, opened = 0, most = 0;
    uint64_t random = seed_of_run();
    srv_peers *peers = srv_peers_new(CONNECTIONS);
    assert_non_null(peers);
    for (int round = 0; round < ROUNDS; round++) {
        random = random * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
        const unsigned draw = (unsigned)(random >> 33);
        if (opened == CONNECTIONS || (opened > 0 && draw % 5 < 2)) {
            const size_t i = draw / 5 % opened;
            srv_peers_leave(peers, held[i].place);
            counts[held[i].address]--;
            held[i] = held[--opened];
            continue;
        }
        char text[32];
        const unsigned address = draw / 5 % ADDRESSES;
        snprintf(text, sizeof text, "10.0.0.%u", address);
        const api_rate_key key = srv_address_key(text);
        size_t count = 0;
        held[opened].place = srv_peers_enter(peers, &key, &count);
        held[opened++].address = address;
        assert_int_equal(count, ++counts[address]);
        most = count > most ? count : most;
    }
    assert_true(most > 2);
    while (opened > 0) {
        srv_peers_leave(peers, held[--opened].place);
    }
    srv_peers_free(peers);
}

/* If the table has no free entry for the address of a connection, the connection must not be
 * counted, and closing it must change no count. */
static void a_full_table_counts_those_it_has(void **state)
{
    (void)state;
    const api_rate_key keys[] = {srv_address_key("10.0.0.1"), srv_address_key("10.0.0.2"),
                                 srv_address_key("10.0.0.3")};
    size_t count = 9;
    srv_peers *peers = srv_peers_new(2);
    assert_non_null(peers);
    const uint32_t first = srv_peers_enter(peers, &keys[0], &count);
    const uint32_t second = srv_peers_enter(peers, &keys[1], &count);
    assert_true(first != SRV_NO_PEER && second != SRV_NO_PEER && first != second);
    assert_int_equal(srv_peers_enter(peers, &keys[2], &count), SRV_NO_PEER);
    assert_int_equal(count, 0);
    srv_peers_leave(peers, SRV_NO_PEER);
    assert_int_equal(srv_peers_enter(peers, &keys[0], &count), first);
    assert_int_equal(count, 2);
    srv_peers_leave(peers, first);
    srv_peers_leave(peers, second);
    assert_int_not_equal(srv_peers_enter(peers, &keys[2], &count), SRV_NO_PEER);
    assert_int_equal(count, 1);
    srv_peers_free(peers);
}

static void a_table_without_memory_is_none(void **state)
{
    (void)state;
    failing f = {0};
    while (failing_next(&f)) {
        srv_peers *peers = srv_peers_new(10);
        failing_end(&f, peers != NULL);
        srv_peers_free(peers);
    }
    /* each of the three allocations has failed once: the table, its hash heads and its entries */
    assert_int_equal(f.n, 4);
}

/* Computing the key of an address must allocate nothing, so it cannot fail when memory is out. */
static void an_address_key_needs_no_memory(void **state)
{
    (void)state;
    failing_at(1);
    const api_rate_key starved = srv_address_key("unix:uid=1000");
    failing_off();
    const api_rate_key key = srv_address_key("unix:uid=1000");
    assert_memory_equal(&starved, &key, sizeof key);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_address_is_a_client_and_of_ipv6_a_network_is),
        cmocka_unit_test(each_address_has_the_connections_that_came_and_did_not_leave),
        cmocka_unit_test(a_full_table_counts_those_it_has),
        cmocka_unit_test(a_table_without_memory_is_none),
        cmocka_unit_test(an_address_key_needs_no_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
