#!/usr/bin/env bash
# twin/campaign/cluster/parallel.sh for real, on this machine and by ssh to itself. parallel_test.sh SOURCE_DIR PROGRAM
source "$(dirname "$0")/common.sh"
sshd=
trap '[[ -n $sshd ]] && kill "$sshd"; rm -rf "$work"' EXIT
command -v parallel >/dev/null || Skip "GNU parallel is not installed (apt-get install parallel)"
parallel=$source_dir/twin/campaign/cluster/parallel.sh
SmallCampaign

"$parallel" "$work/C.toml" "$work/here" 3
Expect "three shards by GNU parallel" "$work/here"
"$parallel" "$work/C.toml" "$work/here" 3 || Fail "a second call of a finished campaign failed"

# 75 is tried again, anything else is not.
FakeProgram "$work/busy" 75 0
TUBETWIN=$work/busy "$parallel" "$work/C.toml" "$work/busy.out" 1 2>/dev/null || Fail "75 was not tried again"
[[ $(Runs "$work/busy") == 2 ]] || Fail "75, then 0: $(Runs "$work/busy") runs"
FakeProgram "$work/broken" 78 0
code=0
TUBETWIN=$work/broken "$parallel" "$work/C.toml" "$work/broken.out" 1 2>/dev/null || code=$?
[[ $code == 78 && $(Runs "$work/broken") == 1 ]] || Fail "78: exit $code after $(Runs "$work/broken") runs"
# One full disk ends its own shard: what is unfinished beside it is tried again, and only then it ends with 74.
cat >"$work/full" <<SH
#!/usr/bin/env bash
echo "\$PARALLEL_SEQ" >>"$work/full.runs"
[[ \$PARALLEL_SEQ == 1 ]] && exit 74
((\$(grep -c 2 "$work/full.runs") > 1)) || exit 75
SH
chmod +x "$work/full"
code=0
TUBETWIN=$work/full "$parallel" "$work/C.toml" "$work/full.out" 2 2>/dev/null || code=$?
[[ $code == 74 ]] || Fail "a full disk: exit $code, not 74"
[[ $(grep -c 2 "$work/full.runs") == 2 ]] || Fail "an unfinished shard beside a full disk was not tried again"
for words in "$work/C.toml $work/x 0" "$work/C.toml $work/x two" "$work/C.toml $work/x"; do
  code=0
  # shellcheck disable=SC2086  # several words on purpose
  "$parallel" $words 2>/dev/null || code=$?
  [[ $code == 64 ]] || Fail "parallel.sh $words: exit $code, not 64"
done

# By ssh: a server of our own on the loopback address, with keys of its own.
sshd_program=$(command -v sshd || echo /usr/sbin/sshd)
[[ -x $sshd_program ]] || Skip "the part over ssh: there is no sshd (apt-get install openssh-server)"
ssh-keygen -q -t ed25519 -N '' -f "$work/host_key"
ssh-keygen -q -t ed25519 -N '' -f "$work/key"
cp "$work/key.pub" "$work/authorized_keys"
[[ $(id -u) == 0 ]] && mkdir -p /run/sshd
port=$((20000 + $$ % 20000))
"$sshd_program" -D -f /dev/null -p "$port" -h "$work/host_key" -o ListenAddress=127.0.0.1 -o UsePAM=no \
  -o StrictModes=no -o AuthorizedKeysFile="$work/authorized_keys" -o PidFile=none \
  -o PermitRootLogin=prohibit-password 2>"$work/sshd.log" &
sshd=$!
ssh="ssh -p $port -i $work/key -o BatchMode=yes -o StrictHostKeyChecking=no -o UserKnownHostsFile=/dev/null -o LogLevel=ERROR"
for _ in $(seq 50); do
  $ssh "$(id -un)@127.0.0.1" true 2>/dev/null && break
  kill -0 "$sshd" 2>/dev/null || { cat "$work/sshd.log" >&2; sshd=; Skip "the part over ssh: sshd does not start"; }
  sleep 0.1
done
$ssh "$(id -un)@127.0.0.1" true || Skip "the part over ssh: no login with a key"
HOSTS="2/$ssh $(id -un)@127.0.0.1" "$parallel" "$work/C.toml" "$work/there" 3
Expect "three shards by GNU parallel over ssh" "$work/there"
