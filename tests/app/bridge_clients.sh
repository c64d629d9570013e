#!/usr/bin/env bash
# bridge_clients.sh SOURCE TUBETWIN: public clients of the gripper's and the force/torque sensor's protocols, from PyPI, before
# `tubetwin emulate`. 77 says that the packages cannot be had here.
set -euo pipefail
source_dir=$1 tubetwin=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

packages=(pymodbus pyserial NetFT pynetft)
if ! { python3 -m venv "$folder/venv" &&
  "$folder/venv/bin/pip" install --quiet --disable-pip-version-check "${packages[@]}"; } >"$folder/pip.log" 2>&1; then
  echo "SKIPPED: the Python packages ${packages[*]} cannot be installed, so no public client has seen the emulated devices:"
  tail -3 "$folder/pip.log"
  exit 77
fi
"$folder/venv/bin/pip" list --disable-pip-version-check 2>/dev/null | grep -iE "^(pymodbus|pyserial|netft|pynetft) "
"$folder/venv/bin/python" "$source_dir/tests/app/bridge_clients.py" "$tubetwin"
