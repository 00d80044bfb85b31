% Overlays of self-regulating populations on the page; facts overlay/4, see
% doc/page.md.

overlay('resource of agents', bar, log(resource(Resource)), Resource).
overlay('deaths', bar, log(state(death)), add(1)).
overlay('clones', bar, log(cloned), add(1)).
