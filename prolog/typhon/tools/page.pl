:- module(typhon_page,
          [ page_start/1,               % +Options
            page_serve/2,               % +Options, -Link
            page_stop/0,
            people_start/2,             % +Names, +Options
            people_start/3,             % +Names, -Links, +Options
            people_revoke/1,            % +Name
            people_stop/0,
            page_export/3               % +Log, +File, +Options
          ]).
:- autoload('page/people_server',
            [people_end/0, people_revoked/1, people_serve/3, qr_code/2]).
:- autoload('page/replay', [replay_export/3]).
:- autoload('page/server', [server_start/2, server_stop/0]).
:- use_module(library(error), [must_be/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/2]).
:- use_module('../kernel/base/options', [check_options/2]).

/** <module> A web page to watch and control a network

The server is loaded when the page is started: a process without a page does
not load the libraries of HTTP.  This is the interface of the layer.

*Threading*: any thread.
*/

:- multifile
    prolog:message//1,
    typhon_options:declared/4.

typhon_options:declared(page_option, host(X), atom, X).
typhon_options:declared(page_option, port(X), between(0, 65535), X).
typhon_options:declared(page_option, bind(X), atom, X).
typhon_options:declared(page_option, read_only(X), boolean, X).
typhon_options:declared(page_option, overlays(X), list, X).
typhon_options:declared(page_option, world(X), callable, X).
typhon_options:declared(page_option, model(X), callable, X).

%!  page_start(+Options:list) is det.
%!  page_stop is det.
%
%   Serve a page that shows live, and lets users control, the hosts of this
%   process, of the networks that it has started, and of all hosts that links
%   from these lead to, and the agents on them.  The link to the page is
%   printed; a user who has it has all rights of this process.  Options:
%
%     - port(+Port): default 8080; 0 for any
%     - host(+Address): also show the network of this host of another process
%     - bind(+Interface): default localhost
%     - read_only(+Boolean): whether the page lets users only watch; default
%       `false`
%     - overlays(+Files): files of agent programs, or studies, whose overlays
%       are shown, besides those of the programs in agents/
%     - world(+Goal): a view World shows, twice a second, the picture that
%       call(Goal, Svg) returns; Goal is qualified by its module
%     - model(Goal): a view Model sets up and runs a program with parameters,
%       and plots what it measures, by call(Goal, Request), see page/models.pl;
%       Goal is qualified by its module
%
%   page_stop/0 stops the page, and succeeds if there is none.
%
%   @error permission_error(start, page, Port) there is a page already, at Port
%   @error domain_error(page_option, Option)
%   @error existence_error(host, Address), host_unreachable(Address)

page_start(Options) :-
    page_serve(Options, Link),
    print_message(informational, typhon(page(Link))).

%!  page_serve(+Options:list, -Link:atom) is det.
%
%   As page_start/1, but Link is returned and not printed.

page_serve(Options, Link) :-
    check_options(page_option, Options),
    server_start(Options, Link).

page_stop :-
    (   current_module(typhon_page_server)
    ->  server_stop
    ;   true
    ).

%!  people_start(+Names:list(atom), +Options:list) is det.
%!  people_start(+Names:list(atom), -Links:list, +Options:list) is det.
%
%   Give each person of Names a host, on which agents can ask that person, and
%   a link to a page with a form.  A host Name that has people(true) already is
%   kept, and gets a new link in place of its old one; others are started.  The
%   links are printed; or Links are pairs Name-Link.  Who has a link answers for
%   that person, and can do nothing else.  Options:
%
%     - port(+Port), bind(+Interface): of the server, default 8081 and localhost
%     - advertise(+Address): what links say in place of Interface
%     - seconds(+Seconds): time for which the links are valid, default 12 hours
%     - link(+Host): each new host is linked to Host, see link/2
%     - hosts(+Options): of host_start/2, for the new hosts
%     - qr(+Boolean): print the links as QR codes, too; needs the program
%       qrencode
%
%   @error permission_error(start, people, Port): the server runs already, and
%          Options say where
%   @error permission_error(invite, host, Name): the host has not people(true)
%   @error existence_error(option, advertise(_)) with bind('0.0.0.0')
%   @error domain_error(people_option, Option)

people_start(Names, Options) :-
    people_start(Names, Links, Options),
    forall(member(Name-Link, Links),
           print_message(informational, typhon(person(Name, Link)))),
    ( option(qr(true), Options) -> print_codes(Links) ; true ).

print_codes(Links) :-
    (   forall(member(Name-Link, Links), print_code(Name, Link))
    ->  true
    ;   print_message(warning, typhon(no_qr_code))
    ).

print_code(Name, Link) :-
    qr_code(Link, Lines),
    print_message(informational, typhon(qr_code(Name, Lines))).

people_start(Names, Links, Options) :-
    check_options(people_option, Options),
    must_be(list(atom), Names),
    people_serve(Names, Links, Options).

%!  people_revoke(+Name) is det.
%!  people_stop is det.
%
%   Make the link of the person Name invalid; questions go on waiting for the
%   next link.  Stop the server; hosts and valid links remain.
%
%   @error existence_error(person, Name)

people_revoke(Name) :-
    people_revoked(Name).

people_stop :-
    (   current_module(typhon_people_server)
    ->  people_end
    ;   true
    ).

typhon_options:declared(people_option, port(X), between(0, 65535), X).
typhon_options:declared(people_option, bind(X), atom, X).
typhon_options:declared(people_option, advertise(X), atom, X).
typhon_options:declared(people_option, seconds(X), nonneg, X).
typhon_options:declared(people_option, link(X), atom, X).
typhon_options:declared(people_option, hosts(X), list, X).
typhon_options:declared(people_option, qr(X), boolean, X).

%!  page_export(+Log, +File, +Options:list) is det.
%
%   Write a page to File that replays the log file Log, in the same views.  File
%   is self-contained, so it can be published with a paper.  Options:
%
%     - title(+Text): default the name of the log
%     - overlays(+Files): files of agent programs, or studies, whose overlays
%       are shown, besides those of the programs in agents/
%
%   @error existence_error(source_sink, Log), permission_error(open,
%   source_sink, File)
%   @error existence_error(page_tool, Name) before `make page-tools`

page_export(Log, File, Options) :-
    check_options(export_option, Options),
    replay_export(Log, File, Options).

typhon_options:declared(export_option, title(X), atomic, X).
typhon_options:declared(export_option, overlays(X), list, X).

prolog:message(typhon(page(Link))) -->
    [ 'The page: ~w'-[Link] ].
prolog:message(typhon(person(Name, Link))) -->
    [ '~w: ~w'-[Name, Link] ].
prolog:message(typhon(qr_code(Name, Lines))) -->
    [ '~w:'-[Name] ],
    qr_lines(Lines).
prolog:message(typhon(no_qr_code)) -->
    [ 'No QR codes: install the program qrencode (apt install qrencode)' ].

%   The codes are light on dark, also in terminals with a light background.

qr_lines([]) -->
    [].
qr_lines([Line|Lines]) -->
    [ nl, ansi([fg(white), bg(black)], '~w', [Line]) ],
    qr_lines(Lines).
