/* certificate.h - the certificate that a TLS listener shows, and how another takes its place.
 *
 * A pair of a certificate and its key is in force. A handshake holds the pair with which it began,
 * so that a pair read meanwhile changes nothing for it, nor for the connection that comes of it. A
 * pair is freed when it is not in force any more and nobody holds it. Every function but new and
 * free may be called by any thread. */
#ifndef HE_SERVER_TLS_CERTIFICATE_H
#define HE_SERVER_TLS_CERTIFICATE_H

#include <gnutls/abstract.h>
#include <stdbool.h>
#include <stddef.h>

enum {
    SRV_MAX_PEM = 256 * 1024, /* bytes of a file */
    SRV_MAX_CHAIN = 16 /* certificates in one: the server's own and those that vouch for it */
};

/* TLS 1.2 and 1.3, of 1.2 only what has forward secrecy and authenticates what it encrypts. */
extern const char srv_tls_priorities[];

typedef struct srv_certificates srv_certificates;
typedef struct srv_certificate srv_certificate;

/* No pair is in force yet. NULL when memory is out. */
srv_certificates *srv_certificates_new(void);
/* Accepts NULL. Pairs that are held stay until they are released. */
void srv_certificates_free(srv_certificates *certificates);

/* Puts the pair of these two files in force: PEM, the chain beginning with the server's own
 * certificate, and a key that is not encrypted. False with a sentence in `message`, which names the
 * file and what is wrong with it: then what was in force before still is. */
bool srv_certificates_read(srv_certificates *certificates, const char *certificate_path,
                           const char *key_path, char *message, size_t size);

/* Gives the pair in force, which there must be. The caller releases it. */
srv_certificate *srv_certificates_hold(srv_certificates *certificates);
/* Accepts NULL. */
void srv_certificate_release(srv_certificate *certificate);

/* What gnutls_certificate_set_retrieve_function3(3) wants of a pair. It is borrowed: the pair is
 * held as long as the session. */
void srv_certificate_show(srv_certificate *certificate, gnutls_pcert_st **chain,
                          unsigned int *length, gnutls_privkey_t *key);

#endif
