# An image of hedged with its page: only the program, what it links and what a browser loads.
#
#   docker build -t hedge .
#   docker run --rm hedge --new-token alice write        # a token, and the line for the file
#   docker run --read-only -v hedge:/data -v "$PWD/tokens:/tokens:ro" -e HEDGE_TOKENS=/tokens \
#       -p 127.0.0.1:8080:8080 hedge
#
# In a container, hedged must listen on an address that other machines can reach. It does so only with
# a file of tokens, or with HEDGE_INSECURE=1, which allows requests without a token. -p decides which
# machines can connect: with 127.0.0.1 before the port, only this one. tests/container.sh builds and
# tries the image.
ARG DEBIAN=docker.io/library/debian:bookworm-slim

# --- the daemon ---
FROM ${DEBIAN} AS build
WORKDIR /src
COPY .ci/deps .ci/
RUN apt-get -q update && apt-get -q install -y --no-install-recommends make && sh .ci/deps build
COPY Makefile ./
COPY core core
COPY api api
COPY server server
ARG REVISION=
RUN make build/hedged COMMIT="$REVISION" && strip build/hedged

# --- its page ---
# The manual shows answers of this very program, so the page is made where the program can run.
FROM build AS page
RUN sh .ci/deps web
COPY web/package.json web/package-lock.json web/
RUN cd web && npm ci --omit=dev --no-audit --no-fund
COPY LICENSE ./
COPY web web
RUN node web/manual/record.mjs /src/build/hedged /src/build/manual.json && \
    cd web && WEB_OUT=/src/build/web MANUAL=/src/build/manual.json npm run build

# --- what runs ---
FROM ${DEBIAN}
ARG REVISION=
LABEL org.opencontainers.image.title="hedge" \
      org.opencontainers.image.description="A server for half-edge meshes over HTTP" \
      org.opencontainers.image.licenses="MIT" \
      org.opencontainers.image.version="0.1.0" \
      org.opencontainers.image.revision="${REVISION}"
RUN apt-get -q update && \
    apt-get -q install -y --no-install-recommends \
        libmicrohttpd12 libcjson1 zlib1g libisal2 libzstd1 libsqlite3-0 libmeshoptimizer2d libamd2 libnettle8 libgnutls30 && \
    rm -rf /var/lib/apt/lists/* /var/cache/apt/*.bin /var/log/*
COPY LICENSE /usr/local/share/doc/hedge/
COPY --from=page /src/build/web /usr/local/share/hedge/web
COPY --from=build /src/build/hedged /usr/local/bin/
# Meshes are kept here, and nothing else is written to.
RUN install -d -o 10001 -g 10001 -m 700 /data
VOLUME /data
# The health check reads the port from here too, --backup and --restore the store.
ENV HEDGE_LISTEN=0.0.0.0:8080 HEDGE_STORE=sqlite:/data
EXPOSE 8080
USER 10001:10001
STOPSIGNAL SIGTERM
HEALTHCHECK --interval=10s --timeout=5s --start-period=5s --retries=3 \
    CMD ["hedged", "--healthcheck"]
ENTRYPOINT ["hedged"]
