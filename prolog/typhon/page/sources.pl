:- module(typhon_page_sources,
          [ sources_start/1,            % +Options
            sources_stop/0,
            scene/2                     % +Most, -Scene
          ]).
:- use_module(library(option), [option/2]).
:- use_module('../host',
              [host_property/2, runtime_acquire/2, runtime_release/1]).
:- use_module('../people', [survey/4, survey_agents/2, survey_hosts/4]).

/** <module> What a page shows: which hosts, and what happens on them

*Threading*: starting and stopping are done by one thread at a time; any
thread looks.
*/

:- dynamic place/1.                     % Address: where to begin

%!  sources_start(+Options) is det.
%!  sources_stop is det.
%
%   A page shows this process, the networks that it has started, and with the
%   option host(Address) that host, and all to which one comes from these.
%
%   @error existence_error(host, Address), host_unreachable(Address)

sources_start(Options) :-
    (   option(host(Address), Options)
    ->  runtime_acquire(page, []),
        catch(must_be_there(Address), Ball,
              ( runtime_release(page), throw(Ball) )),
        assertz(place(Address))
    ;   true
    ).

must_be_there(Address) :-
    host_property(Address, address(_)),
    !.

sources_stop :-
    (   retract(place(_))
    ->  runtime_release(page)
    ;   true
    ).

%!  scene(+Most, -Scene) is det.
%
%   Scene is scene(Hosts, Agents), of each process the first Most agents; see
%   survey/4.

scene(Most, scene(Hosts, Agents)) :-
    findall(Place, place(Place), Places),
    survey(Most, Places, Seen, Silent),
    survey_hosts(Places, Seen, Silent, Hosts),
    survey_agents(Seen, Agents).
