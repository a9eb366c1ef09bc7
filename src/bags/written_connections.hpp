/// \file
/// The connections of a bag that is being written, and their ids.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>

#include "fast_edi/bags/bag_index.hpp"

namespace fast_edi {

/// Ids have no gaps unless a source has them: who appends to a bag takes their number as the next.
class WrittenConnections {
 public:
  using Connections = std::map<std::uint32_t, BagConnection>;

  /// Takes all connections of a source under the ids that they have there.
  /// \pre nothing else was called before
  void keep(const Connections& source);

  /// That of a source, which is always the same one.
  const BagConnection& of(const BagConnection& source);
  /// The program's own, of which each topic has one.
  /// \param own with all but its id and header
  const BagConnection& ofOwn(const BagConnection& own);

  /// Whether it is the first time that this is asked of the connection.
  bool isNew(const BagConnection& connection) { return described_.insert(connection.id).second; }

  const Connections& all() const { return all_; }

 private:
  BagConnection& add(const BagConnection& connection);

  Connections all_;
  std::map<std::uint32_t, std::uint32_t> ids_;  ///< by those of the source
  std::map<std::string, std::uint32_t> own_topics_;
  std::set<std::uint32_t> described_;
  std::uint32_t next_id_ = 0;  ///< the least that may be free
};

}  // namespace fast_edi
