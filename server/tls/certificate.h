/* certificate.h - the certificate of the TLS listener, and its replacement.
 *
 * One pair of a certificate and its key is in force. A handshake holds a reference to the pair with
 * which it began, so that a replacement affects neither it nor its connection. A pair is freed when
 * it is not in force any more and its last reference is released. Any thread may call the
 * functions, except new and free. */
#ifndef HE_SERVER_TLS_CERTIFICATE_H
#define HE_SERVER_TLS_CERTIFICATE_H

#include <gnutls/abstract.h>
#include <stdbool.h>
#include <stddef.h>

enum {
    SRV_MAX_PEM = 256 * 1024, /* bytes of a file */
    SRV_MAX_CHAIN = 16        /* certificates in a file: the server's own and its intermediates */
};

/* The priorities for gnutls: TLS 1.2 and 1.3; of 1.2 only cipher suites with forward secrecy and
 * authenticated encryption. */
extern const char srv_tls_priorities[];

typedef struct srv_certificates srv_certificates;
typedef struct srv_certificate srv_certificate;

/* Makes an object without a pair of certificate and key. Returns NULL when memory is out. */
srv_certificates *srv_certificates_new(void);
/* Frees the object, which may be NULL. Pairs to which references are held stay until these are
 * released. */
void srv_certificates_free(srv_certificates *certificates);

/* Puts the pair of these two files in force: in PEM, the chain beginning with the server's own
 * certificate, the key not encrypted. Returns false with a sentence in `message`, which names the
 * file and the fault; the old pair then stays in force. */
bool srv_certificates_read(srv_certificates *certificates, const char *certificate_path,
                           const char *key_path, char *message, size_t size);

/* Returns a reference to the pair in force, which must exist. The caller releases it. */
srv_certificate *srv_certificates_hold(srv_certificates *certificates);
/* Takes NULL. */
void srv_certificate_release(srv_certificate *certificate);

/* Fills the outputs of gnutls_certificate_set_retrieve_function3(3). They are borrowed from the
 * pair, which must be referenced as long as the session exists. */
void srv_certificate_show(srv_certificate *certificate, gnutls_pcert_st **chain,
                          unsigned int *length, gnutls_privkey_t *key);

#endif
