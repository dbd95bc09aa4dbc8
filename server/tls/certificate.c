#include "server/tls/certificate.h"

#include "base/mem.h"

#include <errno.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

enum { KEY_ID = 64 };

const char srv_tls_priorities[] =
    "SECURE128:-VERS-ALL:+VERS-TLS1.3:+VERS-TLS1.2:-KX-ALL:+ECDHE-ECDSA:+ECDHE-RSA:+DHE-RSA:"
    "-MAC-ALL:+AEAD:%SERVER_PRECEDENCE";

struct srv_certificate {
    _Atomic size_t holders; /* number of references, including that of the member `current` */
    gnutls_pcert_st chain[SRV_MAX_CHAIN];
    unsigned int length;
    gnutls_privkey_t key;
};

struct srv_certificates {
    pthread_mutex_t lock;
    srv_certificate *current; /* the pair in force; NULL if no pair was read yet */
};

/* --- reading --- */

typedef struct file {
    const char *path;
    char *text;
    size_t length;
} file;

static bool load(file *f, char *message, size_t size)
{
    FILE *in = fopen(f->path, "rbe");
    f->text = he_mem_alloc(SRV_MAX_PEM + 1);
    bool ok = in != NULL && f->text != NULL;
    if (ok) {
        f->length = fread(f->text, 1, SRV_MAX_PEM + 1, in);
        ok = ferror(in) == 0;
    }
    if (!ok) {
        snprintf(message, size, "%s cannot be read: %s", f->path,
                 in != NULL && f->text == NULL ? "no memory" : strerror(errno));
    } else if (f->length > SRV_MAX_PEM) {
        snprintf(message, size,
                 "%s is longer than the %d bytes that a file of certificates or keys may have",
                 f->path, SRV_MAX_PEM);
        ok = false;
    }
    if (in != NULL) {
        fclose(in);
    }
    return ok;
}

/* Frees the contents of a file. The bytes are overwritten first, so that the key does not stay in
 * freed memory. */
static void unload(file *f)
{
    if (f->text != NULL) {
        explicit_bzero(f->text, f->length);
    }
    he_mem_free(f->text);
}

static gnutls_datum_t datum_of(const file *f)
{
    return (gnutls_datum_t){(unsigned char *)f->text, (unsigned)f->length};
}

/* Writes that a file is not PEM; `code` is gnutls's reason, whose text ends with a full stop. */
static void tell_not_pem(const file *f, const char *what, int code, char *message, size_t size)
{
    const char *why = gnutls_strerror(code);
    snprintf(message, size, "%s has no %s in PEM: %.*s", f->path, what, (int)strcspn(why, "."),
             why);
}

static bool read_chain(srv_certificate *pair, const file *f, char *message, size_t size)
{
    const gnutls_datum_t data = datum_of(f);
    unsigned int length = SRV_MAX_CHAIN;
    int code = gnutls_pcert_list_import_x509_raw(pair->chain, &length, &data, GNUTLS_X509_FMT_PEM,
                                                 GNUTLS_X509_CRT_LIST_IMPORT_FAIL_IF_EXCEED);
    if (code == GNUTLS_E_SHORT_MEMORY_BUFFER) {
        snprintf(message, size, "%s has more than %d certificates", f->path, SRV_MAX_CHAIN);
    } else if (code < 0) {
        tell_not_pem(f, "certificate", code, message, size);
    }
    pair->length = code < 0 ? 0 : length;
    return code >= 0;
}

static bool read_key(srv_certificate *pair, const file *f, char *message, size_t size)
{
    const gnutls_datum_t data = datum_of(f);
    int code = gnutls_privkey_init(&pair->key);
    if (code >= 0) {
        code = gnutls_privkey_import_x509_raw(pair->key, &data, GNUTLS_X509_FMT_PEM, NULL, 0);
    }
    if (code == GNUTLS_E_DECRYPTION_FAILED) {
        snprintf(
            message, size,
            "%s is encrypted, and hedged does not ask for a passphrase: decrypt the file first",
            f->path);
    } else if (code < 0) {
        tell_not_pem(f, "private key", code, message, size);
    }
    return code >= 0;
}

static bool is_key_of(const srv_certificate *pair)
{
    unsigned char own[KEY_ID], shown[KEY_ID];
    size_t own_length = sizeof own, shown_length = sizeof shown;
    gnutls_pubkey_t key;
    if (gnutls_pubkey_init(&key) < 0) {
        return false;
    }
    bool same = gnutls_pubkey_import_privkey(key, pair->key, 0, 0) >= 0 &&
                gnutls_pubkey_get_key_id(key, GNUTLS_KEYID_USE_SHA256, own, &own_length) >= 0 &&
                gnutls_pubkey_get_key_id(pair->chain[0].pubkey, GNUTLS_KEYID_USE_SHA256, shown,
                                         &shown_length) >= 0 &&
                own_length == shown_length && memcmp(own, shown, own_length) == 0;
    gnutls_pubkey_deinit(key);
    return same;
}

static srv_certificate *read_pair(const char *certificate_path, const char *key_path, char *message,
                                  size_t size)
{
    file certificate = {.path = certificate_path}, key = {.path = key_path};
    srv_certificate *pair = he_mem_zero(1, sizeof *pair);
    bool ok = pair != NULL;
    if (!ok) {
        snprintf(message, size, "no memory for a certificate");
    } else {
        atomic_init(&pair->holders, 1);
        ok = load(&certificate, message, size) && read_chain(pair, &certificate, message, size) &&
             load(&key, message, size) && read_key(pair, &key, message, size);
    }
    if (ok && !is_key_of(pair)) {
        snprintf(message, size, "the key in %s does not belong to the first certificate in %s",
                 key_path, certificate_path);
        ok = false;
    }
    unload(&certificate);
    unload(&key);
    if (!ok) {
        srv_certificate_release(pair);
        return NULL;
    }
    return pair;
}

/* --- references --- */

void srv_certificate_release(srv_certificate *certificate)
{
    if (certificate == NULL || atomic_fetch_sub(&certificate->holders, 1) > 1) {
        return;
    }
    for (unsigned int i = 0; i < certificate->length; i++) {
        gnutls_pcert_deinit(&certificate->chain[i]);
    }
    if (certificate->key != NULL) {
        gnutls_privkey_deinit(certificate->key);
    }
    he_mem_free(certificate);
}

void srv_certificate_show(srv_certificate *certificate, gnutls_pcert_st **chain,
                          unsigned int *length, gnutls_privkey_t *key)
{
    *chain = certificate->chain;
    *length = certificate->length;
    *key = certificate->key;
}

srv_certificates *srv_certificates_new(void)
{
    srv_certificates *certificates = he_mem_zero(1, sizeof *certificates);
    if (certificates != NULL) {
        pthread_mutex_init(&certificates->lock, NULL);
    }
    return certificates;
}

void srv_certificates_free(srv_certificates *certificates)
{
    if (certificates != NULL) {
        srv_certificate_release(certificates->current);
        pthread_mutex_destroy(&certificates->lock);
        he_mem_free(certificates);
    }
}

bool srv_certificates_read(srv_certificates *certificates, const char *certificate_path,
                           const char *key_path, char *message, size_t size)
{
    srv_certificate *pair = read_pair(certificate_path, key_path, message, size), *before;
    if (pair == NULL) {
        return false;
    }
    pthread_mutex_lock(&certificates->lock);
    before = certificates->current;
    certificates->current = pair;
    pthread_mutex_unlock(&certificates->lock);
    srv_certificate_release(before);
    return true;
}

srv_certificate *srv_certificates_hold(srv_certificates *certificates)
{
    pthread_mutex_lock(&certificates->lock);
    srv_certificate *pair = certificates->current;
    atomic_fetch_add(&pair->holders, 1);
    pthread_mutex_unlock(&certificates->lock);
    return pair;
}
