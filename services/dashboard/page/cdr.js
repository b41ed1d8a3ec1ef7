// Decodes plain CDR with the IDL text that every channel carries: structs, enums, arrays, bounded strings.
// The comments of the IDL are the explanations that the page shows.

const SIZES = { boolean: 1, octet: 1, char: 1, int16: 2, uint16: 2, int32: 4, uint32: 4, int64: 8, uint64: 8, float: 4, double: 8 };

/** @returns {{structs: Map, enums: Map}} structs: name -> [{name, type, count, meaning}]; enums: name -> [{name, meaning}] */
export function parseIdl(text) {
  const structs = new Map(), enums = new Map();
  let body = null;
  for (const line of text.split("\n")) {
    const [code, meaning = ""] = line.split("//").map((part) => part.trim());
    let match;
    if ((match = code.match(/^(?:@final\s+)?(struct|enum)\s+(\w+)\s*\{/))) {
      body = { kind: match[1], entries: [] };
      (body.kind === "struct" ? structs : enums).set(match[2], body.entries);
    } else if (code.startsWith("}")) {
      body = null;
    } else if (body?.kind === "enum" && (match = code.match(/^(\w+),?$/))) {
      body.entries.push({ name: match[1], meaning });
    } else if (body?.kind === "struct" && (match = code.match(/^(?:@key\s+)?(\w+)(?:<\d+>)?\s+(\w+)(?:\[(\d+)\])?;/))) {
      body.entries.push({ type: match[1], name: match[2], count: Number(match[3] ?? 0), meaning });
    }
  }
  return { structs, enums };
}

/** Decoder of one type: the elementary values in order, each with its path: "header.tick", "applied_v[0]". */
export class Decoder {
  constructor(idl, typeName) {
    this.columns = [];
    this.#flatten(idl, typeName.replace(/^.*::/, ""), "", "");
    this.index = new Map(this.columns.map((column, i) => [column.path, i]));
  }

  #flatten(idl, type, prefix, inherited) {
    for (const field of idl.structs.get(type)) {
      for (let i = 0; i < Math.max(1, field.count); ++i) {
        const path = prefix + field.name + (field.count ? `[${i}]` : "");
        const meaning = field.meaning || inherited;
        if (idl.structs.has(field.type)) this.#flatten(idl, field.type, path + ".", meaning);
        else this.columns.push({ path, meaning, kind: idl.enums.has(field.type) ? "enum" : field.type, values: idl.enums.get(field.type) });
      }
    }
  }

  /** Numbers, booleans as 0 and 1, enums as their number, strings; 64-bit integers as numbers (ns keep 0.1 µs). */
  decode(view) {
    const little = view.getUint8(1) === 1;
    const values = new Array(this.columns.length);
    let at = 4;
    const align = (size) => { at = 4 + Math.ceil((at - 4) / size) * size; };
    for (let i = 0; i < this.columns.length; ++i) {
      const kind = this.columns[i].kind;
      if (kind === "string") {
        align(4);
        const length = view.getUint32(at, little);
        values[i] = new TextDecoder().decode(new Uint8Array(view.buffer, view.byteOffset + at + 4, Math.max(0, length - 1)));
        at += 4 + length;
        continue;
      }
      const size = kind === "enum" ? 4 : SIZES[kind];
      align(size);
      values[i] = read(view, at, kind, little);
      at += size;
    }
    return values;
  }
}

function read(view, at, kind, little) {
  switch (kind) {
    case "double": return view.getFloat64(at, little);
    case "float": return view.getFloat32(at, little);
    case "int64": return Number(view.getBigInt64(at, little));
    case "uint64": return Number(view.getBigUint64(at, little));
    case "int32": return view.getInt32(at, little);
    case "enum": case "uint32": return view.getUint32(at, little);
    case "int16": return view.getInt16(at, little);
    case "uint16": return view.getUint16(at, little);
    default: return view.getUint8(at);
  }
}
