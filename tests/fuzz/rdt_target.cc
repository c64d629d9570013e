// Both sides of raw data transfer: refused with a reason, or the same bytes after a round trip.

#include <cstdio>
#include <cstdlib>

#include "hw_bridge/codecs/rdt.h"
#include "tests/fuzz/byte_target.h"

namespace tubetwin {
namespace {

void Require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "raw data transfer: %s\n", what);
  std::abort();
}

}  // namespace

void TryBytes(std::string_view bytes) {
  const auto request = DecodeRdtRequest(bytes);
  if (const auto* error = std::get_if<DecodeError>(&request)) {
    Require(!error->reason.empty(), "a request refused without a reason");
  } else {
    Require(EncodeRdtRequest(std::get<RdtRequest>(request)) == bytes, "another request");
  }
  const auto records = DecodeRdtRecords(bytes);
  if (const auto* error = std::get_if<DecodeError>(&records)) {
    Require(!error->reason.empty(), "records refused without a reason");
    return;
  }
  std::string again;
  const RdtScale scale{1e6, 1e6};
  for (const RdtRecord& record : std::get<std::vector<RdtRecord>>(records)) {
    EncodeRdtRecord(record, again);
    const Wrench wrench = scale.WrenchOf(record.counts);
    Require(wrench.force_N.allFinite() && wrench.torque_Nm.allFinite(), "a wrench without end");
    Require(scale.CountsOf(wrench) == record.counts, "other counts");
    Require(RdtStatusText(record.status).empty() == (record.status == 0), "a status without text");
  }
  Require(again == bytes, "other records");
}

std::vector<std::string> ByteCorpus() {
  std::string records;
  RdtRecord record;
  record.rdt_sequence = 1;
  record.ft_sequence = 1000;
  record.counts = {1500000, -2500000, 10000000, 100000, -200000, 50000};
  EncodeRdtRecord(record, records);
  std::vector<std::string> corpus = {records};
  record.status = kRdtErrorSummary | kRdtSaturation;
  EncodeRdtRecord(record, records);
  corpus.push_back(records);
  corpus.push_back(EncodeRdtRequest({RdtCommand::kStartRealTime, 0}));
  corpus.push_back(EncodeRdtRequest({RdtCommand::kSetBias, 0}));
  return corpus;
}

}  // namespace tubetwin
