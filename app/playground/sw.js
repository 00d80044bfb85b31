// Keeps the files of the playground, so that it works without a network after
// the first visit. The build writes the version and the names.

'use strict';

const CACHE = `typhon-playground-${"VERSION"}`;
const FILES = "FILES";

addEventListener('install', event => event.waitUntil((async () => {
  const cache = await caches.open(CACHE);
  await cache.addAll(FILES.map(name => new Request(name, { cache: 'no-cache' })));
  await skipWaiting();
})()));

addEventListener('activate', event => event.waitUntil((async () => {
  for (const name of await caches.keys())
    if (name.startsWith('typhon-playground-') && name !== CACHE) await caches.delete(name);
  await clients.claim();
})()));

addEventListener('fetch', event => {
  if (event.request.method !== 'GET') return;
  event.respondWith((async () => {
    const kept = await (await caches.open(CACHE))
      .match(event.request, { ignoreSearch: true });
    if (kept) return kept;
    if (event.request.mode === 'navigate') {
      const start = await (await caches.open(CACHE)).match('index.html');
      if (start && new URL(event.request.url).pathname.endsWith('/')) return start;
    }
    return fetch(event.request);
  })());
});
