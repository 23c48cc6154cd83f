#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# cura_definitions.sh FOLDER: unpacks the printer definitions of the Debian package `cura` into FOLDER, unless they are
# there. The package itself is not installed: of it, the engine needs these files only.
set -eu
folder=$1
[ -d "$folder/usr/share/cura/resources/definitions" ] && exit 0
mkdir -p "$folder"
cd "$folder"
apt-get -qq download cura > download.log 2>&1
dpkg-deb -x cura_*.deb .
rm -f cura_*.deb
