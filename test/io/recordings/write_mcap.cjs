// Writes an MCAP file with @mcap/core and @foxglove/rosmsg2-serialization, which are not ours.
//
//   node write_mcap.cjs FILE none|lz4|zstd chunked|plain SCANS [POINTS]
//
// Scan k has POINTS + k points; what they are, test_foreign_recordings.cpp knows.
const { spawnSync } = require("child_process");
const fs = require("fs");
const { McapWriter } = require("@mcap/core");
const { MessageWriter } = require("@foxglove/rosmsg2-serialization");
const { parse } = require("@foxglove/rosmsg");

const [file, compression, layout, scans, points] = process.argv.slice(2);
const definition = `std_msgs/Header header
uint32 height
uint32 width
sensor_msgs/PointField[] fields
bool is_bigendian
uint32 point_step
uint32 row_step
uint8[] data
bool is_dense
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: sensor_msgs/PointField
string name
uint32 offset
uint8 datatype
uint32 count
`;

// 26 bytes a point: x y z intensity, ring, time as float64 at an address that no processor likes.
function cloud(k, count) {
  const data = Buffer.alloc(26 * count);
  for (let i = 0; i < count; ++i) {
    data.writeFloatLE(k + 0.25 * i, 26 * i);
    data.writeFloatLE(-i, 26 * i + 4);
    data.writeFloatLE(0.5 * k, 26 * i + 8);
    data.writeFloatLE(i % 256, 26 * i + 12);
    data.writeUInt16LE(i % 64, 26 * i + 16);
    data.writeDoubleLE((0.1 * i) / count, 26 * i + 18);
  }
  const field = (name, offset, datatype) => ({ name, offset, datatype, count: 1 });
  return {
    header: { stamp: { sec: 1700000000 + Math.floor(k / 10), nanosec: (k % 10) * 100000000 }, frame_id: "lidar" },
    height: 1,
    width: count,
    fields: [field("x", 0, 7), field("y", 4, 7), field("z", 8, 7), field("intensity", 12, 7), field("ring", 16, 4),
             field("time", 18, 8)],
    is_bigendian: false,
    point_step: 26,
    row_step: 26 * count,
    data: new Uint8Array(data),
    is_dense: true,
  };
}

function compressed(data) {
  const command = compression === "lz4" ? ["lz4", ["-c", "-q"]] : ["zstd", ["-c", "-q"]];
  const result = spawnSync(command[0], command[1], { input: data, maxBuffer: 1 << 30 });
  if (result.status !== 0) {
    throw new Error(`${command[0]} failed`);
  }
  return { compression, compressedData: new Uint8Array(result.stdout) };
}

class Output {
  constructor() { this.file = fs.openSync(file, "w"); this.bytes = 0n; }
  position() { return this.bytes; }
  async write(data) { fs.writeSync(this.file, data); this.bytes += BigInt(data.length); }
}

async function main() {
  const writer = new McapWriter({
    writable: new Output(),
    useChunks: layout === "chunked",
    chunkSize: points ? 4 << 20 : 20000,
    compressChunk: compression === "none" ? undefined : compressed,
  });
  await writer.start({ profile: "ros2", library: "test" });
  const schemaId = await writer.registerSchema({
    name: "sensor_msgs/msg/PointCloud2", encoding: "ros2msg", data: Buffer.from(definition) });
  const textId = await writer.registerSchema({
    name: "std_msgs/msg/String", encoding: "ros2msg", data: Buffer.from("string data\n") });
  const channel = (schema, topic) => writer.registerChannel(
    { schemaId: schema, topic, messageEncoding: "cdr", metadata: new Map() });
  const other = await channel(textId, "/chatter");
  const lidar = await channel(schemaId, "/lidar/points");
  const clouds = new MessageWriter(parse(definition, { ros2: true }));
  const texts = new MessageWriter(parse("string data", { ros2: true }));
  for (let k = 0; k < Number(scans); ++k) {
    const time = 1700000000000000000n + BigInt(k) * 100000000n;
    const message = (channelId, data) => writer.addMessage(
      { channelId, sequence: k, logTime: time, publishTime: time, data });
    await message(other, texts.writeMessage({ data: "x".repeat(k % 9) }));
    await message(lidar, clouds.writeMessage(cloud(k, Number(points ?? 100) + k)));
  }
  await writer.end();
}

main().catch((error) => { console.error(error.message); process.exit(1); });
