# shellcheck shell=sh
# bare.sh - sourced by scripts that need a Debian on which nothing is installed yet.
#
# bare_sources prints lines for apt's sources.list: the mirrors of Debian 12 that this machine's own
# apt uses. bare_debian FOLDER [PACKAGE,...] puts a minimal Debian 12 from the first of them into
# FOLDER, with the packages named; it needs root and debootstrap.
bare_release=bookworm

bare_sources() {
    apt-get indextargets --format '$(RELEASE) $(COMPONENT) $(REPO_URI)' 'Created-By: Packages' |
        awk -v release="$bare_release" '$2 == "main" &&
            ($1 == release || $1 == release "-updates" || $1 == release "-security") {
                print "deb", $3, $1, $2
            }'
}

bare_debian() {
    bare_mirror=$(bare_sources | awk -v release="$bare_release" '$3 == release { print $2; exit }')
    if [ -z "$bare_mirror" ]; then
        echo "this machine's apt has no mirror of $bare_release"
        return 1
    fi
    debootstrap --variant=minbase ${2:+"--include=$2"} "$bare_release" "$1" "$bare_mirror" ||
        return 1
    rm -rf "$1"/var/cache/apt/archives/*.deb "$1"/var/lib/apt/lists/*
}
