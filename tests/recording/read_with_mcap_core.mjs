// Reads a recording with the official MCAP library, by index and as a stream, every CRC checked.
//   npm install @mcap/core @mcap/support      (in the directory of this script or above)
//   node read_with_mcap_core.mjs run.mcap
import fs from 'node:fs/promises';
import {McapIndexedReader, McapStreamReader} from '@mcap/core';
import {loadDecompressHandlers} from '@mcap/support';

const bytes = await fs.readFile(process.argv[2]);
const decompressHandlers = await loadDecompressHandlers();
const readable = {
  size: async () => BigInt(bytes.length),
  read: async (offset, length) => new Uint8Array(bytes.subarray(Number(offset), Number(offset + length))),
};

const reader = await McapIndexedReader.Initialize({readable, decompressHandlers});
let indexed = 0;
let last = 0n;
for await (const message of reader.readMessages({validateCrcs: true})) {
  if (message.logTime < last) throw new Error(`message ${indexed} is out of order`);
  last = message.logTime;
  ++indexed;
}
let attachments = 0;
for await (const attachment of reader.readAttachments({validateCrcs: true})) attachments += attachment.data.length > 0;
let metadata = 0;
for await (const record of reader.readMetadata()) metadata += record.metadata.size > 0;

const stream = new McapStreamReader({decompressHandlers, validateCrcs: true});
stream.append(bytes);
let streamed = 0;
for (let record; (record = stream.nextRecord());) streamed += record.type === 'Message';

const expected = Number(reader.statistics.messageCount);
if (indexed !== expected || streamed !== expected || !stream.done())
  throw new Error(`${expected} messages in the statistics, ${indexed} by index, ${streamed} as a stream`);
console.log(`${expected} messages, ${reader.chunkIndexes.length} chunks, ${reader.channelsById.size} channels, ` +
            `${attachments} attachments, ${metadata} metadata records`);
