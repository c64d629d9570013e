#!/usr/bin/env bash
# bridge_clients.sh SOURCE TUBETWIN: public clients of all devices' protocols, from PyPI and Debian, before `tubetwin emulate`. 77 says that the packages cannot be had here.
set -euo pipefail
source_dir=$1 tubetwin=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

packages=(pymodbus pyserial pyRobotiqGripper NetFT pynetft yrcom)
if ! { python3 -m venv "$folder/venv" &&
  "$folder/venv/bin/pip" install --quiet --disable-pip-version-check "${packages[@]}"; } >"$folder/pip.log" 2>&1; then
  echo "SKIPPED: the Python packages ${packages[*]} cannot be installed, so no public client has seen the emulated devices:"
  tail -3 "$folder/pip.log"
  exit 77
fi
"$folder/venv/bin/pip" list --disable-pip-version-check 2>/dev/null | grep -iE "^(pymodbus|pyserial|pyrobotiqgripper|netft|pynetft|yrcom) "
arv_tool=$(command -v arv-tool-0.8 || true)
if [ -z "$arv_tool" ]; then
  mkdir "$folder/aravis"
  if (cd "$folder/aravis" && apt-get download aravis-tools-cli && dpkg -x aravis-tools-cli_*.deb .) >"$folder/apt.log" 2>&1; then
    chmod 755 "$folder"  # For clients of other users.
    arv_tool="$folder/aravis/usr/bin/arv-tool-0.8"
  else
    echo "SKIPPED: aravis-tools-cli cannot be had, so arv-tool has not seen the emulated scanner: $(tail -1 "$folder/apt.log")"
  fi
fi
ARV_TOOL=$arv_tool "$folder/venv/bin/python" "$source_dir/tests/app/bridge_clients.py" "$tubetwin"
