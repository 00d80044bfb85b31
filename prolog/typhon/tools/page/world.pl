:- module(typhon_page_world,
          [ world_start/1,              % +Options
            world_stop/0,
            world_shown/0,
            world_picture/1             % -Svg
          ]).
:- use_module(library(error), [existence_error/2, must_be/2]).
:- use_module(library(option), [option/2]).

/** <module> The world in which the agents of a page work

With the option world(Goal) the page has a view of what surrounds the agents,
as the rooms of a building, or fields.  call(Goal, Svg) gives its picture now,
the text of an SVG document, which a browser asks for twice a second while it
shows the view.  It shows it as an image: no script in it runs, and nothing that
it refers to is loaded.

*Threading*: starting and stopping are done by one thread at a time; Goal is
called in threads that serve browsers, by several at a time.
*/

:- dynamic shown/1.             % Goal of the page that is served

%!  world_start(+Options) is det.
%!  world_stop is det.
%!  world_shown is semidet.
%
%   While a page is served; world_shown/0 is true if it has a world.

world_start(Options) :-
    (   option(world(Goal), Options)
    ->  assertz(shown(Goal))
    ;   true
    ).

world_stop :-
    retractall(shown(_)).

world_shown :-
    shown(_).

%!  world_picture(-Svg:string) is det.
%
%   @error existence_error(page_view, world), and what Goal raises

world_picture(Svg) :-
    (   shown(Goal)
    ->  once(call(Goal, Text)),
        must_be(text, Text),
        format(string(Svg), '~w', [Text])
    ;   existence_error(page_view, world)
    ).
