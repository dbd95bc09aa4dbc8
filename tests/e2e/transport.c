#include "tests/e2e/transport.h"

#include "tests/store_folder.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>
#include <gnutls/crypto.h>
#include <gnutls/x509.h>

static struct {
    transport way;
    int is_known;
    char folder[FOLDER_PATH]; /* "" if the folder does not exist yet */
    /* the process that removes the folder, which children of fork() must not do */
    pid_t owner;
    char certificate[FOLDER_PATH + 20], key[FOLDER_PATH + 20], listen[FOLDER_PATH + 20];
    unsigned sockets;
} chosen;

static const char *const names[] = {"tcp", "tls", "unix"};

transport transport_get(void)
{
    const char *name = getenv("TRANSPORT");
    if (chosen.is_known || name == NULL || *name == '\0') {
        return chosen.way;
    }
    for (int i = 0; i < 3; i++) {
        if (strcmp(name, names[i]) == 0) {
            transport_choose((transport)i);
            return chosen.way;
        }
    }
    fail_msg("TRANSPORT is tcp, tls or unix, not \"%s\"", name);
    return chosen.way;
}

void transport_choose(transport way)
{
    chosen.way = way;
    chosen.is_known = 1;
}

void transport_skip_over(transport way, const char *reason)
{
    if (transport_get() == way) {
        print_message("note: not over %s: %s\n", names[way], reason);
        skip();
    }
}

const char *transport_peer(void)
{
    static char user[40];
    snprintf(user, sizeof user, "unix:uid=%u", (unsigned)geteuid());
    return transport_get() == TRANSPORT_UNIX ? user : "127.0.0.1";
}

static void remove_folder(void)
{
    if (getpid() == chosen.owner) {
        folder_remove(chosen.folder);
    }
}

static void make_folder(void)
{
    if (chosen.folder[0] == '\0') {
        folder_make(chosen.folder);
        chosen.owner = getpid();
        assert_int_equal(atexit(remove_folder), 0);
    }
}

const char *transport_certificate(void)
{
    if (chosen.certificate[0] == '\0') {
        make_folder();
        snprintf(chosen.certificate, sizeof chosen.certificate, "%s/certificate.pem",
                 chosen.folder);
        snprintf(chosen.key, sizeof chosen.key, "%s/key.pem", chosen.folder);
        transport_make_pair("localhost", chosen.certificate, chosen.key);
    }
    return chosen.certificate;
}

const char *const *transport_options(void)
{
    static const char *options[TRANSPORT_OPTIONS];
    size_t count = 0;
    options[count++] = "--listen";
    options[count++] = "127.0.0.1:0";
    switch (transport_get()) {
    case TRANSPORT_TCP:
        break;
    case TRANSPORT_TLS:
        options[count++] = "--tls-cert";
        options[count++] = transport_certificate();
        options[count++] = "--tls-key";
        options[count++] = chosen.key;
        break;
    case TRANSPORT_UNIX:
        make_folder();
        snprintf(chosen.listen, sizeof chosen.listen, "unix:%s/%u", chosen.folder,
                 ++chosen.sockets);
        options[count - 1] = chosen.listen;
        break;
    }
    options[count] = NULL;
    return options;
}

/* --- certificates --- */

static void must(int code)
{
    if (code < 0) {
        fail_msg("gnutls: %s", gnutls_strerror(code));
    }
}

static void write_pem(const char *path, gnutls_datum_t pem)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_int_equal(fwrite(pem.data, 1, pem.size, file), pem.size);
    assert_int_equal(fclose(file), 0);
    gnutls_free(pem.data);
}

void transport_make_pair(const char *name, const char *certificate, const char *key)
{
    enum { DAY = 86400 };
    static const unsigned char loopback[4] = {127, 0, 0, 1};
    unsigned char serial[8] = {1};
    char subject[100];
    gnutls_x509_privkey_t secret;
    gnutls_x509_crt_t shown;
    gnutls_datum_t pem;
    snprintf(subject, sizeof subject, "CN=%s", name);
    must(gnutls_rnd(GNUTLS_RND_NONCE, serial + 1, sizeof serial - 1));
    must(gnutls_x509_privkey_init(&secret));
    must(gnutls_x509_privkey_generate(secret, GNUTLS_PK_ECDSA,
                                      GNUTLS_CURVE_TO_BITS(GNUTLS_ECC_CURVE_SECP256R1), 0));
    must(gnutls_x509_crt_init(&shown));
    must(gnutls_x509_crt_set_version(shown, 3));
    must(gnutls_x509_crt_set_serial(shown, serial, sizeof serial));
    must(gnutls_x509_crt_set_dn(shown, subject, NULL));
    must(gnutls_x509_crt_set_activation_time(shown, time(NULL) - DAY));
    must(gnutls_x509_crt_set_expiration_time(shown, time(NULL) + 2 * DAY));
    must(gnutls_x509_crt_set_subject_alt_name(shown, GNUTLS_SAN_DNSNAME, "localhost", 9,
                                              GNUTLS_FSAN_SET));
    must(gnutls_x509_crt_set_subject_alt_name(shown, GNUTLS_SAN_IPADDRESS, loopback,
                                              sizeof loopback, GNUTLS_FSAN_APPEND));
    must(gnutls_x509_crt_set_basic_constraints(shown, 1, -1));
    must(gnutls_x509_crt_set_key(shown, secret));
    must(gnutls_x509_crt_sign2(shown, shown, secret, GNUTLS_DIG_SHA256, 0));
    must(gnutls_x509_crt_export2(shown, GNUTLS_X509_FMT_PEM, &pem));
    write_pem(certificate, pem);
    must(gnutls_x509_privkey_export2(secret, GNUTLS_X509_FMT_PEM, &pem));
    write_pem(key, pem);
    gnutls_x509_crt_deinit(shown);
    gnutls_x509_privkey_deinit(secret);
}
