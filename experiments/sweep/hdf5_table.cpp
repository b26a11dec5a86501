#include "experiments/sweep/hdf5_table.hpp"

#include <algorithm>
#include <cstring>
#include <functional>
#include <memory>
#include <stdexcept>

#include "experiments/record/files/hdf5/handle.hpp"
#include "experiments/text/choice.hpp"

namespace beamid::experiments {
namespace {

/// A member of the compound type, and how a row's bytes of it are made.
struct Member {
  std::string name;
  std::size_t size = 8;
  enum class Kind { whole, number, text } kind = Kind::number;
  std::function<void(const SweepRow&, char*)> put;
};

Member whole(const std::string& name, const std::function<std::int64_t(const SweepRow&)>& value) {
  return {name, 8, Member::Kind::whole, [value](const SweepRow& row, char* place) {
            const std::int64_t number = value(row);
            std::memcpy(place, &number, sizeof number);
          }};
}

Member number_cell(const std::string& name, const std::function<double(const SweepRow&)>& value) {
  return {name, 8, Member::Kind::number, [value](const SweepRow& row, char* place) {
            const double found = value(row);
            std::memcpy(place, &found, sizeof found);
          }};
}

Member text(const std::string& name, const std::function<const std::string&(const SweepRow&)>& value,
            const std::vector<SweepRow>& rows) {
  std::size_t size = 1;
  for (const SweepRow& row : rows) size = std::max(size, value(row).size());
  return {name, size, Member::Kind::text, [value](const SweepRow& row, char* place) {
            std::copy(value(row).begin(), value(row).end(), place);
          }};
}

std::vector<Member> members_of(const SweepPlan& plan, const std::vector<SweepRow>& rows) {
  std::vector<Member> members{
      whole("case", [](const SweepRow& row) { return static_cast<std::int64_t>(row.number); }),
      whole("seed", [](const SweepRow& row) { return static_cast<std::int64_t>(row.seed); })};
  for (std::size_t j = 0; j < plan.varied.size(); ++j) {
    const VariedKey& key = plan.varied[j];
    const bool numeric =
        std::all_of(key.values.begin(), key.values.end(),
                    [](const filters::OptionValue& value) { return std::holds_alternative<double>(value); });
    if (numeric)
      members.push_back(number_cell(key.key, [j](const SweepRow& row) {
        return experiments::number(row.values[j]).value_or(std::nan(""));
      }));
    else
      members.push_back(text(
          key.key, [j](const SweepRow& row) -> const std::string& { return row.values[j]; }, rows));
  }
  for (const auto& [name, member] : text_columns())
    members.push_back(text(
        name, [member = member](const SweepRow& row) -> const std::string& { return row.*member; }, rows));
  for (const auto& [name, member] : number_columns())
    members.push_back(number_cell(name, [member = member](const SweepRow& row) { return row.*member; }));
  return members;
}

hid_t type_of(const Member& member) {
  if (member.kind == Member::Kind::whole) return H5Tcopy(H5T_NATIVE_INT64);
  if (member.kind == Member::Kind::number) return H5Tcopy(H5T_NATIVE_DOUBLE);
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, member.size);
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  return type;
}

}  // namespace

void write_hdf5(const SweepPlan& plan, const std::vector<SweepRow>& rows, const std::filesystem::path& file) {
  const std::vector<Member> members = members_of(plan, rows);
  std::size_t width = 0;
  for (const Member& member : members) width += member.size;
  std::vector<char> bytes(width * rows.size(), '\0');
  const hid_t compound = H5Tcreate(H5T_COMPOUND, width);
  std::size_t offset = 0;
  for (const Member& member : members) {
    const hid_t type = type_of(member);
    H5Tinsert(compound, member.name.c_str(), offset, type);
    H5Tclose(type);
    for (std::size_t i = 0; i < rows.size(); ++i) member.put(rows[i], bytes.data() + i * width + offset);
    offset += member.size;
  }
  const hsize_t count = rows.size();
  const hid_t out = H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hid_t space = H5Screate_simple(1, &count, nullptr);
  const hid_t timeless = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_obj_track_times(timeless, false);
  const hid_t set =
      out < 0 ? -1 : H5Dcreate2(out, "cases", compound, space, H5P_DEFAULT, timeless, H5P_DEFAULT);
  bool written = set >= 0 && H5Dwrite(set, compound, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()) >= 0;
  if (set >= 0) written = H5Dclose(set) >= 0 && written;
  H5Pclose(timeless);
  H5Sclose(space);
  H5Tclose(compound);
  if (out >= 0) written = H5Fclose(out) >= 0 && written;
  if (!written) throw std::runtime_error("cannot write '" + file.string() + "'");
}

}  // namespace beamid::experiments
