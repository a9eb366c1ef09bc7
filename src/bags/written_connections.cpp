#include "bags/written_connections.hpp"

#include <boost/make_shared.hpp>

namespace fast_edi {

void WrittenConnections::keep(const Connections& source) {
  all_ = source;
  for (const auto& entry : source) {
    ids_[entry.first] = entry.first;
  }
}

const BagConnection& WrittenConnections::of(const BagConnection& source) {
  const auto known = ids_.find(source.id);
  if (known != ids_.end()) {
    return all_.at(known->second);
  }
  const BagConnection& added = add(source);
  ids_[source.id] = added.id;
  return added;
}

const BagConnection& WrittenConnections::ofOwn(const BagConnection& own) {
  const auto known = own_topics_.find(own.topic);
  if (known != own_topics_.end()) {
    return all_.at(known->second);
  }
  BagConnection& added = add(own);
  added.header = boost::make_shared<ros::M_string>();
  (*added.header)["type"] = own.datatype;
  (*added.header)["md5sum"] = own.md5sum;
  (*added.header)["message_definition"] = own.definition;
  own_topics_[own.topic] = added.id;
  return added;
}

BagConnection& WrittenConnections::add(const BagConnection& connection) {
  while (all_.count(next_id_) > 0) {
    ++next_id_;
  }
  BagConnection& added = all_[next_id_] = connection;
  added.id = next_id_;
  return added;
}

}  // namespace fast_edi
