// A program as the fragment of an address: deflated JSON, in the letters that
// addresses may have.

const LONGEST = 2e6;            // characters of a program that a link may have

const through = (stream, bytes) =>
  new Response(new Blob([bytes]).stream().pipeThrough(stream)).arrayBuffer();

// Only these parts, of these kinds, are taken from a link.
function checked({ files, queries, study = null, folder = null }) {
  const texts = list => Array.isArray(list) && list.every(text => typeof text === 'string');
  if (!Array.isArray(files) || !files.every(file => texts(file) && file.length === 2)
      || !texts(queries) || ![study, folder].every(name =>
        name === null || typeof name === 'string'))
    throw new Error('It has no program');
  return { files, queries, study: study ?? undefined, folder: folder ?? undefined };
}

export const Share = {
  async pack(program) {
    const bytes = new Uint8Array(await through(new CompressionStream('deflate-raw'),
      JSON.stringify(checked(program))));
    let text = '';
    for (const byte of bytes) text += String.fromCharCode(byte);
    return btoa(text).replace(/\+/g, '-').replace(/\//g, '_').replace(/=+$/, '');
  },

  async unpack(text) {
    if (text.length > LONGEST) throw new Error('It is too long');
    const bytes = Uint8Array.from(atob(text.replace(/-/g, '+').replace(/_/g, '/')),
      letter => letter.charCodeAt(0));
    const stream = new Blob([bytes]).stream()
      .pipeThrough(new DecompressionStream('deflate-raw')).getReader();
    const parts = [];
    for (let size = 0; ;) {                     // a small link may grow large
      const { done, value } = await stream.read();
      if (done) break;
      size += value.length;
      if (size > LONGEST) throw new Error('It is too long');
      parts.push(value);
    }
    return checked(JSON.parse(await new Blob(parts).text()));
  },
};
