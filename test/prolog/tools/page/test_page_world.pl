:- module(test_page_world, []).
:- use_module('../../../lib/common').

:- needs([chromium, 'chromium-driver']).

% The view of the world, which the goal of a page draws.

:- use_module('../../../lib/browser').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/pages').
:- use_module(library(debug), [assertion/1]).
:- use_module(library(plunit)).
:- use_module(library(typhon)).

picture(Svg) :-
    flag(test_page_world_looks, N, N+1),
    Width is 100+N,
    format(atom(Svg),
           '<svg xmlns="http://www.w3.org/2000/svg" width="~d" height="50">\c
            <script>parent.hit = 1</script></svg>', [Width]).

fault(_) :-
    throw(error(resource_error(paint), _)).

:- meta_predicate page(+, -, 0).

page(Options, Base, Goal) :-
    flag(test_page_world_looks, _, 0),
    with_hosts([alpha], with_page(Options, Base, Goal)).

seen(Base, Script) :-
    with_browser(Browser,
                 ( browser_open(Browser, Base),
                   browser_wait(Browser, Script) )).

:- begin_tests(page_world).

test(world_is_drawn) :-
    page([world(test_page_world:picture)], Base,
         ( ask(Base, _{ask:"world"}, _),
           ask(Base, _{ask:"world"}, Told) )),
    assertion(sub_string(Told.answer, _, _, _, "width=\"101\"")).

test(host_without_a_world) :-
    page([], Base, ask(Base, _{ask:"world"}, Told)),
    assertion(sub_string(Told.error, _, _, _, "world")).

test(faulty_drawing) :-
    page([world(test_page_world:fault)], Base, ask(Base, _{ask:"world"}, Told)),
    assertion(sub_string(Told.error, _, _, _, "paint")).

test(world_is_no_goal, error(type_error(_, _))) :-
    page([world(1)], _, true).

%   The drawing is shown repeatedly, and its script does not run.

test(shown_world) :-
    page([world(test_page_world:picture)], Base,
         seen(Base, "return document.querySelector('.view-world img')\c
                     ?.naturalWidth > 102 && globalThis.hit === undefined")).

:- end_tests(page_world).
