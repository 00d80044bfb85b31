:- module(site_reference,
          [ reference_dom/1             % -Dom
          ]).

/** <module> The reference: what PlDoc knows of the public predicates

Predicates are grouped by what users want to do with them: task/3. Those that
share a comment share an entry.

*Threading*: the main thread. PlDoc notes comments while files are loaded,
so this module is loaded before any other that loads library(typhon).
*/

:- use_module(library(apply), [maplist/3]).
:- use_module(library(http/html_write), [print_html/1]).
:- use_module(library(lists), [append/2, member/2]).
:- use_module(library(pairs), [group_pairs_by_key/2, pairs_values/2]).
:- use_module(library(pldoc)).
:- use_module(library(pldoc/doc_html), []).
:- use_module(library(pldoc/doc_process), [doc_comment/4]).
:- use_module(library(uri), [uri_components/2, uri_query_components/2]).
:- use_module(dom,
              [dom_attribute/3, dom_edit/3, dom_element/2, html_dom/2]).
:- use_module(markdown, [slug/2]).

:- doc_collect(true).
:- use_module('../../prolog/typhon', []).
:- use_module('../../prolog/typhon/network/networks', []).  % else on demand
:- use_module('../../prolog/typhon/nxt', []).
:- use_module('../../prolog/typhon/fipa', []).
:- doc_collect(false).

                /*******************************
                *             TASKS            *
                *******************************/

%   part(?Id, ?Title).

part(agents, "Inside an agent").
part(library, "At the top level and in programs: library(typhon)").
part(fipa, "Platforms of FIPA: library(typhon/fipa)").
part(robots, "Robots: library(typhon/nxt)").

%   task(?Part, ?Title, ?Modules): Modules are those that define the predicates
%   of the task, or Module:PIs if some are of other tasks.

task(agents, "Move, clone and end",
     [ typhon_words:[move/1, clone/1, clone/2, dispose/0], typhon_memory ]).
task(agents, "Wait, and exchange messages",
     [ typhon_words:[sleep/1, receive/1, receive/2, send/2] ]).
task(agents, "Know where it is",
     [ typhon_words:[ self/1, here/1, home/1, parent/1, hops/1, now/1,
                      host_load/1, neighbours/1, neighbour/2 ] ]).
task(agents, "Share facts on a host",
     [ typhon_words:[leave/1, leave_new/1, sense/1, take/1] ]).
task(agents, "Report results and events",
     [ typhon_words:[result/1, log/1, enter/1], typhon_seals:[seal/3] ]).
task(agents, "Carry and deliver payloads",
     [ typhon_words:[attach/1, detach/1, deliver/1, undeliver/1] ]).
task(agents, "Call agents by pheromones",
     [ typhon_words:[emit/1, emit/2, withdraw/1, pheromone/3] ]).
task(library, "Start, change and stop hosts", [typhon_hosting, typhon_changing]).
task(library, "Link hosts, and ask them",
     [typhon_host_questions, typhon_remote]).
task(library, "Start networks, and read their logs", [typhon_network]).
task(library, "Check programs", [typhon_checks]).
task(library, "Create agents", [typhon_creation]).
task(library, "Write to agents, and order them about",
     [typhon_sending, typhon_order_client]).
task(library, "Wait for agents, and end them", [typhon_join, typhon_disposal]).
task(library, "Look into agents",
     [ typhon_environment, typhon_properties, typhon_source_view, typhon_tracing,
       typhon_stepping, typhon_trails ]).
task(library, "Watch a network", [typhon_watching, typhon_page]).
task(library, "Save and restore agents", [typhon_restore]).
task(library, "Use Python, MQTT, ROS and FIPA", [typhon_starting]).
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
    exported(typhon_words, Module:PI),
    PI \== message_failed/2.            % is for the machine
public(agents, PI) :-
    exported(typhon_memory, PI).
public(agents, typhon_seals:seal/3).
public(library, PI) :-
    exported(typhon, PI).
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

%   What PlDoc shows of a comment, and whereto it refers.

entry_dom(Entry, Dom) :-
    Entry = entry(Place, Comment, [PI|_]),
    PI = Module:_,
    phrase(pldoc_html:objects([doc(PI, Place, Comment)],
                              [navtree(false), module(Module)]), Tokens),
    tokens_dom(Tokens, Dom).

tokens_dom(Tokens, Dom) :-
    with_output_to(string(Html), print_html(Tokens)),
    html_dom(Html, Dom).

pldoc_link(Element, PI) :-
    dom_attribute(Element, href, Link),
    sub_atom(Link, 0, _, _, '/pldoc/doc_for?'),
    uri_components(Link, uri_components(_, _, _, Query, _)),
    uri_query_components(Query, [object=Object]),
    term_to_atom(PI, Object),
    PI = _:_/_.

%   As it stands on our page. PlDoc makes links for its own server.

settle(Known, element(a, As, Dom), Nodes) :-
    pldoc_link(element(a, As, Dom), _:Name/Arity),
    !,
    atomic_list_concat([Name, Arity], /, Id),
    (   memberchk(Id, Known)
    ->  atom_concat(#, Id, Link),
        Nodes = [element(a, [href=Link], [element(code, [], Dom)])]
    ;   Nodes = [element(code, [], Dom)]
    ).
settle(_, element(a, As, Dom), [element(a, [href=Link], Dom)]) :-
    memberchk(href=Manual, As),
    sub_atom(Manual, 0, _, _, '/pldoc/'),
    atom_concat('https://www.swi-prolog.org', Manual, Link).
settle(_, element(a, As, Dom), [element(a, [id=Id, href=Link], Dom)]) :-
    memberchk(name=Id, As),
    atom_concat(#, Id, Link).
settle(_, element(span, [style='float:right'], _), []).

                /*******************************
                *             PAGE             *
                *******************************/

%!  reference_dom(-Dom) is det.
%
%   The page of all public predicates. The id of a predicate is its name and
%   arity; the first entry of two with one name has it.
%
%   @error existence_error(task, PI): a public predicate that no task has

reference_dom([element(h1, [id=predicates], ["All predicates"])|Dom]) :-
    forall(public(Part, PI), has_task(Part, PI)),
    findall(Node, ( part(Part, Title), part_node(Part, Title, Node) ), Dom0),
    findall(PI, ( dom_element(Dom0, E), dom_attribute(E, name, PI) ), Known),
    dom_edit(settle(Known), Dom0, Dom).

has_task(Part, PI) :-
    task(Part, _, Modules),
    of_task(Part, Modules, PI),
    !.
has_task(_, PI) :-
    throw(error(existence_error(task, PI), _)).

part_node(Part, Title, element(h2, [id=Part], [Title])).
part_node(Part, _, Node) :-
    task(Part, Title, Modules),
    findall(Entry,
            ( member(Module, Modules),
              findall(PI, of_task(Part, [Module], PI), PIs),
              entries(PIs, Entries),
              member(Entry, Entries) ),
            All),
    maplist(entry_dom, All, Doms),
    append(Doms, Dom),
    findall(Link, name_link(Dom, Link), Links),
    slug(Title, Slug),
    atomic_list_concat([Part, Slug], -, Id),
    member(Node, [ element(h3, [id=Id], [Title]),
                   element(p, [class=names], Links)
                 | Dom ]).

name_link(Dom, Node) :-
    findall(Name, ( dom_element(Dom, E), dom_attribute(E, name, Name) ),
            Names0),
    sort(Names0, Names),
    member(Name, Names),
    atom_concat(#, Name, Link),
    member(Node, [element(a, [href=Link], [Name]), " "]).
