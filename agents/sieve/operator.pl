:- module(sieve_operator,
          [ sieve_start/3,              % +Hosts, +Application, +Options
            antigen_attack/2,           % +Hosts, +Antigen
            antibody_release/5          % +Host, +Application, +Antibody,
                                        % +Options, -Agent
          ]).
:- use_module('../../prolog/typhon',
              [agent_create/3, agent_send/2, remote/2]).
:- use_module('../../prolog/typhon/kernel/base/options', [check_options/2]).
:- use_module('../../prolog/typhon/kernel/program/paths', []).
:- use_module('../lib/settings', [setting_facts/2]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(error), [existence_error/2, must_be/2]).
:- use_module(library(lists), [memberchk/2]).

/** <module> The idiotypic sieve, as seen from outside

Puts guards on hosts, and attacks these with antigens (thesis chapter 3).
Antibodies the hosts make themselves.  Hosts are addresses, so all this works
from any process that holds the cookie, whoever started the hosts.

An application is a payload file, as payloads(sieve/bits), that provides

  - affinity(+Antigen, +Antibody, -Psi), affinity_threshold(-Gamma)
    A number, and from which on an antibody can neutralize the antigen.
  - feedback(+Antigen, +Antibody, -Xi)
    How well it did: the argument of equation 3.2.
  - random_antibody(+Chance0, -Antibody, -Chance)
    Drawn by typhon_prng.
  - similar(+Antigen, +Other)
    May be missing; then antigens that differ are not similar.

*Threading*: any thread; no state.
*/

:- multifile typhon_options:declared/4.

%!  sieve_start(+Hosts, +Application, +Options) is det.
%
%   Hosts get a guard that knows Application, where they have none.
%   Options: settings(Pairs), Name-Value, to replace what parameters.pl has
%   as a default, for the guards and all antibodies they release.
%
%   @error domain_error(sieve_option, Option)
%   @error type_error(list, X), existence_error(host, Host),
%   host_unreachable(Host)

sieve_start(Hosts, Application, Options) :-
    must_be(list(atom), Hosts),
    check_options(sieve_option, Options),
    setting_facts(Options, Settings),
    maplist(guarded(Application, Settings), Hosts).

typhon_options:declared(sieve_option, settings(X), list, X).

guarded(_, _, Host) :-
    remote(Host, sense(guard(_))),
    !.
guarded(Application, Settings, Host) :-
    agent_create(agents(sieve/guard), Guard,
                 [ host(Host), static(true), payloads([Application]),
                   facts([application(Application)|Settings])
                 ]),
    remote(Host, leave(guard(Guard))).

%!  antigen_attack(+Hosts, +Antigen) is det.
%
%   Antigen, a ground term, attacks each of Hosts.  A host that is under
%   attack meets this one afterwards.
%
%   @error existence_error(guard, Host), host_unreachable(Host)

antigen_attack(Hosts, Antigen) :-
    must_be(list(atom), Hosts),
    must_be(ground, Antigen),
    maplist(attack(Antigen), Hosts).

attack(Antigen, Host) :-
    (   remote(Host, sense(guard(Guard)))
    ->  agent_send(Guard, attack(Antigen))
    ;   existence_error(guard, Host)
    ).

%!  antibody_release(+Host, +Application, +Antibody, +Options, -Agent)
%!      is det.
%
%   Agent, at Host, carries Antibody, and has never met an antigen.  Options
%   are those of sieve_start/3.

antibody_release(Host, Application, Antibody, Options, Agent) :-
    check_options(sieve_option, Options),
    setting_facts(Options, Settings),
    (   memberchk(setting(gamma, Gamma), Settings)
    ->  true
    ;   Gamma = 1.0
    ),
    agent_create(agents(sieve/antibody), Agent,
                 [ host(Host), payloads([Application]),
                   facts([ antibody(Antibody), gamma(Gamma), memory([]),
                           wins(0), expiry(inf), shunned([])
                         | Settings
                         ])
                 ]).
