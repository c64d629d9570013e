#include "models/files/json_visitor.h"

#include <algorithm>

#include "models/base/json.h"
#include "models/base/text.h"

namespace tubetwin {
namespace {

// Any number that is 3.0 in a pile file is fine as an integer, 3.5 is not: JsonView decides.
class Reader : public ConfigVisitor {
 public:
  explicit Reader(const JsonView& object) : object_(object) {}

  using ConfigVisitor::Field;
  void Field(const char* key, const char*, bool& value) override {
    if (const auto field = Find(key)) value = field->AsBool();
  }
  void Field(const char* key, const char*, std::int64_t& value, Range allowed) override {
    const auto field = Find(key);
    if (!field) return;
    value = field->AsInteger();
    CheckRange(*field, static_cast<double>(value), allowed);
  }
  void Field(const char* key, const char*, double& value, Range allowed) override {
    const auto field = Find(key);
    if (!field) return;
    value = field->AsNumber();
    CheckRange(*field, value, allowed);
  }
  void Field(const char* key, const char*, std::string& value) override {
    if (const auto field = Find(key)) value = field->AsString();
  }
  void Choice(const char* key, const char*, std::string& value,
              const std::vector<std::string>& allowed) override {
    const auto field = Find(key);
    if (!field) return;
    value = field->AsString();
    if (std::find(allowed.begin(), allowed.end(), value) == allowed.end()) {
      field->Fail("is '" + value + "'; allowed: " + Join(allowed) + "; nearest is '" +
                  NearestName(value, allowed) + "'");
    }
  }
  void Field(const char* key, const char*, std::vector<double>& value, int count,
             Range allowed) override {
    const auto field = Find(key);
    if (!field) return;
    value = field->AsNumbers();
    if (count > 0 && static_cast<int>(value.size()) != count) {
      field->Fail("has " + std::to_string(value.size()) +
                  " numbers; allowed: " + std::to_string(count));
    }
    for (const double v : value) CheckRange(*field, v, allowed);
  }
  void Field(const char* key, const char*, std::vector<std::string>& value) override {
    const auto field = Find(key);
    if (!field) return;
    value.clear();
    for (std::size_t i = 0; i < field->Size(); ++i) value.push_back(field->Item(i).AsString());
  }
  void Section(const char* key, const char*,
               const std::function<void(ConfigVisitor&)>& visit) override {
    if (const auto field = Find(key)) ReadJsonInto(*field, visit);
  }

  void CheckUnknown() const {
    for (const auto& [key, value] : object_.json().items()) {
      if (std::find(known_.begin(), known_.end(), key) == known_.end()) {
        object_.Fail("has the unknown key '" + key + "'; nearest is '" + NearestName(key, known_) +
                     "'");
      }
    }
  }

 private:
  std::optional<JsonView> Find(const char* key) {
    known_.push_back(key);
    return object_.Optional(key);
  }
  static void CheckRange(const JsonView& field, double value, Range allowed) {
    if (value >= allowed.low && value <= allowed.high) return;
    field.Fail("is " + Number(value) + "; allowed: " + Number(allowed.low) + " to " +
               Number(allowed.high));
  }

  const JsonView& object_;
  std::vector<std::string> known_;
};

class Writer : public ConfigVisitor {
 public:
  using ConfigVisitor::Field;
  void Field(const char* key, const char*, bool& value) override { json_[key] = value; }
  void Field(const char* key, const char*, std::int64_t& value, Range) override {
    json_[key] = value;
  }
  void Field(const char* key, const char*, double& value, Range) override { json_[key] = value; }
  void Field(const char* key, const char*, std::string& value) override { json_[key] = value; }
  void Choice(const char* key, const char*, std::string& value,
              const std::vector<std::string>&) override {
    json_[key] = value;
  }
  void Field(const char* key, const char*, std::vector<double>& value, int, Range) override {
    json_[key] = value;
  }
  void Field(const char* key, const char*, std::vector<std::string>& value) override {
    json_[key] = value;
  }
  void Section(const char* key, const char*,
               const std::function<void(ConfigVisitor&)>& visit) override {
    json_[key] = WriteJson(visit);
  }
  Json Take() { return std::move(json_); }

 private:
  Json json_ = Json::object();
};

}  // namespace

void ReadJsonInto(const JsonView& object, const std::function<void(ConfigVisitor&)>& visit) {
  if (!object.IsObject()) object.Fail("must be an object");
  Reader reader(object);
  visit(reader);
  reader.CheckUnknown();
}

Json WriteJson(const std::function<void(ConfigVisitor&)>& visit) {
  Writer writer;
  visit(writer);
  return writer.Take();
}

}  // namespace tubetwin
