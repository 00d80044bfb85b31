:- module(site_reference,
          [ reference/2                 % -Public, -Markdown
          ]).

/** <module> The reference: what PlDoc knows of the public predicates

Predicates are grouped by what users want to do with them: task/3. Those that
share a comment share an entry.

*Threading*: the main thread. PlDoc notes comments while files are loaded,
so this module is loaded before any other that loads library(typhon).
*/

:- use_module('../../app/packaging/parts', [installed/1, part/3]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(http/html_write), [print_html/1]).
:- use_module(library(lists), [append/2, append/3, member/2]).
:- use_module(library(pairs), [group_pairs_by_key/2, pairs_values/2]).
:- use_module(library(pldoc)).
:- use_module(library(pldoc/doc_html), []).
:- use_module(library(pldoc/doc_process), [doc_comment/4]).
:- use_module(library(sgml), [load_html/3]).
:- use_module(library(sgml_write), [html_write/3]).

:- doc_collect(true).
:- use_module('../../prolog/typhon', []).
:- use_module('../../prolog/typhon/kernel/program', [vocabulary_word/2]).
:- use_module('../../prolog/typhon/network/networks', []).  % else on demand
:- forall(( member(Part-Files,
                   [ nxt-['prolog/typhon/nxt'],
                     fipa-['prolog/typhon/fipa'],
                     bridges-['prolog/typhon/bridges/mqtt/service',
                              'prolog/typhon/bridges/gpio/service',
                              'prolog/typhon/bridges/ros/service'],
                     studies-['agents/sync/operator',
                              'agents/population/operator',
                              'agents/learning/operator',
                              'agents/allocation/operator',
                              'agents/sieve/operator',
                              'agents/hierarchy/operator'] ]),
            installed(Part),
            member(File, Files) ),
          use_module('../..'/File, [])).
:- doc_collect(false).

                /*******************************
                *             TASKS            *
                *******************************/

%   part(?Id, ?Title).

part(agents, "Inside an agent").
part(bridges, "Inside an agent, on hosts with a bridge").
part(library, "At the top level and in programs: library(typhon)").
part(mechanisms, "Mechanisms: modules below agents").
part(fipa, "Platforms of FIPA: library(typhon/fipa)").
part(robots, "Robots: library(typhon/nxt)").

%   task(?Part, ?Title, ?Modules): Modules are those that define the predicates
%   of the task, or Module:PIs if some are of other tasks.

task(agents, "Move, clone and end",
     [ typhon_words:[move/1, move/2, clone/1, clone/2, dispose/0],
       typhon_migration:[next_host/2] ]).
task(agents, "Wait, and exchange messages",
     [ typhon_words:[sleep/1, receive/1, receive/2, send/2] ]).
task(agents, "Create agents, and learn how they end",
     [ typhon_program_words:[create/3], typhon_monitor_words ]).
task(agents, "Know where it is",
     [ typhon_words:[ self/1, here/1, home/1, parent/1, hops/1, now/1,
                      host_load/1, neighbours/1, neighbour/2 ] ]).
task(agents, "Share facts on a host",
     [ typhon_words:[leave/1, leave_new/1, sense/1, take/1] ]).
task(agents, "Report results and events",
     [ typhon_words:[result/1, log/1, enter/1], typhon_seals ]).
task(agents, "Carry and deliver payloads",
     [ typhon_program_words:[attach/1, detach/1, deliver/1, undeliver/1] ]).
task(agents, "Offer and find services", [typhon_directory_words]).
task(agents, "Call agents by pheromones",
     [typhon_migration:[emit/1, emit/2, withdraw/1, pheromone/3]]).
task(bridges, "Publish and subscribe by MQTT", [typhon_mqtt_service]).
task(bridges, "Read and set the pins of a board", [typhon_gpio_service]).
task(bridges, "Topics of ROS", [typhon_ros_service]).
task(bridges, "Services, actions and parameters of ROS", [typhon_ros_requests]).
task(library, "Start, change and stop hosts",
     [typhon_hosting, typhon_administration:[host_change/2]]).
task(library, "Link hosts, and ask them",
     [ typhon_administration:[host_property/2, link/2, link/3, unlink/2,
                              remote/2] ]).
task(library, "Start networks, and read their logs", [typhon_network]).
task(library, "Fleets of machines, and their hosts", [typhon_fleets]).
task(library, "Check programs", [typhon_checks]).
task(library, "Create agents", [typhon_creation]).
task(library, "Write to agents, and order them about",
     [typhon_order_client, typhon_administration:[agent_change/2]]).
task(library, "Wait for agents, and end them",
     [typhon_join, typhon_supervision, typhon_disposal]).
task(library, "Look into agents",
     [ typhon_environment,
       typhon_administration:[agent_property/2, agent_where/2],
       typhon_source_view, typhon_trace, typhon_trails ]).
task(library, "Watch a network", [typhon_watches, typhon_page]).
task(library, "Save and restore agents",
     [typhon_administration:[agent_save/2, agent_load/2, agent_load/3]]).
task(library, "Use Python, MQTT, pins, ROS and FIPA", [typhon_starting]).
task(mechanisms, "Synchronise hosts: agents/sync/operator", [sync_operator]).
task(mechanisms, "Control a population: agents/population/operator",
     [population_operator]).
task(mechanisms, "Learn: agents/learning/operator", [learning_operator]).
task(mechanisms, "Allocate robots: agents/allocation/operator",
     [allocation_operator]).
task(mechanisms, "Sieve: agents/sieve/operator", [sieve_operator]).
task(mechanisms, "Lead: agents/hierarchy/operator", [hierarchy_operator]).
task(fipa, "Ask a platform", [typhon_fipa_service]).
task(robots, "Connect a brick, and use its parts", [typhon_nxt_brick]).
task(robots, "Run motors", [typhon_nxt_motors]).
task(robots, "Read sensors", [typhon_nxt_sensors]).
task(robots, "Files and programs of a brick", [typhon_nxt_files]).
task(robots, "The names of SWI-PRO-NXT", [typhon_nxt_swi_pro_nxt]).
task(robots, "Motors and sensors by the names of SWI-PRO-NXT",
     [typhon_nxt_old_devices]).

%   public(+Part, ?PI): predicates that users may call.

public(agents, Module:PI) :-
    vocabulary_word(Module, PI),
    PI \== message_failed/2.            % is for the machine
public(bridges, typhon_mqtt_service:PI) :-
    installed(bridges),
    member(PI, [publish/2, publish/3, subscribe/1, subscribe/2, unsubscribe/1]).
public(bridges, typhon_gpio_service:PI) :-
    installed(bridges),
    member(PI, [ pin/2, pins/1, pin_watch/1, pin_watch/2, pin_unwatch/1,
                 pin_open/2, pin_close/1, pin_drive/2 ]).
public(bridges, PI) :-
    exported(typhon_ros_service, PI).
public(library, PI) :-
    exported(typhon, PI).
public(mechanisms, Module:PI) :-
    task(mechanisms, _, [Module]),
    exported(Module, Module:PI).
public(fipa, Module:PI) :-
    exported(typhon_fipa, Module:PI),
    \+ exported(typhon, Module:PI).
public(robots, PI) :-
    exported(typhon_nxt, PI).

exported(Module, Definer:PI) :-
    module_property(Module, exports(PIs)),
    member(PI, PIs),
    PI = Name/Arity,
    functor(Head, Name, Arity),
    (   predicate_property(Module:Head, imported_from(Definer0))
    ->  Definer = Definer0
    ;   Definer = Module
    ).

%   of_task(+Part, +Modules, -PI)

of_task(Part, Modules, Module:PI) :-
    member(Item, Modules),
    (   Item = Module:PIs
    ->  member(PI, PIs)
    ;   Item = Module,
        public(Part, Module:PI)
    ).

                /*******************************
                *            ENTRIES           *
                *******************************/

%   entries(+PIs, -Entries): the comments of these, in the order of the
%   file: entry(Place, Comment, PIs).

entries(PIs, Entries) :-
    findall(Place-(Comment-PI),
            ( member(PI, PIs),
              once(doc_comment(PI, Place, _, Comment)) ),
            Pairs0),
    keysort(Pairs0, Pairs),
    group_pairs_by_key(Pairs, Groups),
    maplist(entry, Groups, Entries).

entry(Place-CommentPIs, entry(Place, Comment, PIs)) :-
    CommentPIs = [Comment-_|_],
    pairs_values(CommentPIs, PIs).

%   What PlDoc shows of a comment; it makes links for its own server.

entry_html(entry(Place, Comment, [Module:PI|_]), Html) :-
    phrase(pldoc_html:objects([doc(Module:PI, Place, Comment)],
                              [navtree(false), module(Module)]), Tokens),
    with_output_to(string(Html0), print_html(Tokens)),
    html_dom(Html0, Dom0),
    edited(Dom0, Dom),
    with_output_to(string(Html), html_write(current_output, Dom,
                                            [header(false), layout(false)])).

:- multifile prolog:doc_object_href/2.

prolog:doc_object_href(_:Name/Arity, Link) :-
    public(_, _:Name/Arity),
    !,
    format(atom(Link), '#~w/~w', [Name, Arity]).

html_dom(Html, Dom) :-
    setup_call_cleanup(
        open_string(Html, In),
        load_html(stream(In), Dom, [syntax_errors(quiet), max_errors(-1)]),
        close(In)).

%   Predicates become headings: those the search finds.

edited(Dom0, Dom) :-
    maplist(edit, Dom0, Doms),
    append(Doms, Dom).

edit(element(Name, As, Dom0), Nodes) :-
    !,
    edited(Dom0, Dom),
    (   settled(Name, As, Dom, Nodes)
    ->  true
    ;   Nodes = [element(Name, As, Dom)]
    ).
edit(Text, [Text]).

settled(html, _, Dom, Dom).
settled(head, _, _, []).
settled(body, _, Dom, Dom).
settled(span, ['style'='float:right'|_], _, []).
settled(span, [class=anot|_], _, []).
settled(dl, [], Dom, Dom).
settled(dd, [class=defbody], Dom, [element(div, [class=entry], Dom)]).
settled(dt, _, [element(b, [name=PI], Head)|Det],
        [element(h4, [id=PI], [element(code, [], Head)|Det])]).
settled(a, As, Dom, [element(b, [name=PI], Dom)]) :-
    memberchk(name=PI, As).
settled(a, As, Dom, [element(a, [href=Link], Dom)]) :-
    memberchk(href=Manual, As),
    sub_atom(Manual, 0, _, _, '/pldoc/man'),
    atom_concat('https://www.swi-prolog.org', Manual, Link).
settled(a, As, Dom, [element(code, [], Dom)]) :-
    memberchk(href=Link, As),
    sub_atom(Link, 0, _, _, '/pldoc/').

                /*******************************
                *             PAGE             *
                *******************************/

%!  reference(-Public, -Markdown:string) is det.
%
%   The page of all public predicates, and their names, atoms as `move/1`, which
%   are places of it.
%
%   @error existence_error(task, PI): a public predicate that no task has

reference(Public, Markdown) :-
    forall(public(Part, PI), has_task(Part, PI)),
    findall(Name,
            ( task(Part, _, Modules),
              of_task(Part, Modules, _:PI),
              term_to_atom(PI, Name) ),
            Public),
    findall(Text, ( part(Part, Title), part_text(Part, Title, Text) ), Texts),
    atomic_list_concat(['# All predicates\n\n'|Texts], Markdown).

has_task(Part, PI) :-
    task(Part, _, Modules),
    of_task(Part, Modules, PI),
    !.
has_task(_, PI) :-
    throw(error(existence_error(task, PI), _)).

part_text(_, Title, Text) :-
    format(string(Text), "## ~w~n~n", [Title]).
part_text(Part, _, Text) :-
    task(Part, Title, Modules),
    findall(Entry,
            ( member(Module, Modules),
              findall(PI, of_task(Part, [Module], PI), PIs),
              entries(PIs, Entries),
              member(Entry, Entries) ),
            All),
    maplist(entry_html, All, Entries),
    findall(Name, ( member(entry(_, _, PIs), All), member(_:PI, PIs),
                    format(atom(Name), '`~w`', [PI]) ),
            Names0),
    sort(Names0, Names),
    atomic_list_concat(Names, ' ', Overview),
    atomic_list_concat(Entries, Html),
    format(string(Text), "### ~w~n~n~w~n~n~w~n~n", [Title, Overview, Html]).
